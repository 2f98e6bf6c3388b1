// SPDX-License-Identifier: Apache-2.0

/// Blocks in inverse time that are rounded: tip and axis are nowhere faster than a block nearby
/// asks for, whatever lengths and times follow one another.

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "property/planner/smooth_trace.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::inverse_time {
namespace {

constexpr double kReach_mm = 5;
constexpr double kPosition_mm = 0.02;  // between u of the path and the sum of block lengths
constexpr double kCycle_s = 1e-3;
constexpr double kNone = std::numeric_limits<double>::infinity();

/// The Lai machine with joints that hardly ever hold the feed back.
MachineModel quick_machine() {
  MachineModel model = lai_machine();
  for (JointSpec& joint : model.joints) {
    joint.limits.velocity *= 8;
    joint.limits.acceleration *= 40;
    joint.limits.jerk *= 200;
  }
  return model;
}

/// Seeded programs of straight moves, turns of the axis alone and both, long, short and dense, each
/// with a time of its own; some blocks have a tip feed instead.
class MixedTimes {
 public:
  explicit MixedTimes(std::uint32_t seed) : engine_(seed) { add(Vector3::Zero(), 0); }

  [[nodiscard]] std::vector<ClBlock> make(int sections) {
    for (int n = 0; n < sections; ++n) {
      if (uniform(0, 1) < 0.05) rest();
      const int count = uniform(0, 1) < 0.3 ? static_cast<int>(uniform(5, 40)) : 1;
      const int kind = static_cast<int>(uniform(0, 4));
      const double length = count > 1 ? log_uniform(0.02, 1) : log_uniform(0.05, 30);
      const double turn = length / kAxisLength_mm_per_rad;
      for (int i = 0; i < count; ++i) {
        if (kind == 0) add(length * direction(), 0);
        if (kind == 1) add(Vector3::Zero(), std::min(turn, 0.5));
        if (kind == 2) add(length * direction(), std::min(uniform(0, 2) * turn, 0.5));
        if (kind == 3) add(log_uniform(1e-4, 0.1) * length * direction(), std::min(turn, 0.5));
      }
    }
    end_program(blocks_);
    return blocks_;
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  Vector3 direction() {
    return Vector3(uniform(-1, 1), uniform(-1, 1), uniform(-0.3, 0.3)).normalized();
  }

  void rest() {
    ClBlock block;
    block.kind = BlockKind::kDwell;
    block.value = 0.1;
    put(block);
  }

  void put(ClBlock& block) {
    block.sequence = blocks_.size();
    block.line = static_cast<std::uint32_t>(blocks_.size()) + 10;
    blocks_.push_back(block);
  }

  void add(const Vector3& by, double turn) {
    const double side = uniform(0, 1) < 0.5 ? -1 : 1;
    const double tilt = std::clamp(tilt_ + side * turn, 0.1, 0.9);
    const double block_length =
        std::hypot(by.norm(), kAxisLength_mm_per_rad * std::abs(tilt - tilt_));
    tip_ += by;
    tilt_ = tilt;
    ClBlock block;
    block.tip_mm = to_array(tip_);
    block.axis = {std::sin(tilt_), 0, std::cos(tilt_)};
    const double speed = log_uniform(1, 200);
    const bool is_timed = by.norm() == 0 || uniform(0, 1) < 0.9;
    block.feed_meaning = is_timed ? FeedMeaning::kInverseTime : FeedMeaning::kTip;
    block.feed = is_timed && block_length > 0 ? speed / block_length : speed;
    put(block);
  }

  std::mt19937 engine_;
  Vector3 tip_{20, -30, 10};
  double tilt_ = 0.4;
  std::vector<ClBlock> blocks_;
};

/// What a block asks for over its stretch of u.
struct Asked {
  double begin = 0, end = 0;
  bool is_timed = false;
  double tip_mm_per_s = 0, turn_rad_per_s = 0;
  double min_s = 0;
};

std::vector<Asked> asked_by(const std::vector<ClBlock>& blocks, const MachineModel& model) {
  const auto programmed = programmed_paths(blocks);
  std::vector<Asked> out;
  double u = 0;
  for (std::size_t n = 1; n < blocks.size(); ++n) {
    const double block_length = programmed[n].length, tip = tip_length(programmed[n]),
                 turn = programmed[n].axis_turn;
    if (!is_motion(blocks[n].kind) || !(block_length > 0)) continue;
    const bool is_timed = blocks[n].feed_meaning == FeedMeaning::kInverseTime;
    const double time = is_timed ? 1 / blocks[n].feed : tip / blocks[n].feed;
    const double min_tip = is_timed ? block_length * model.tolerances.tip_mm / kReach_mm : 0;
    const double min_turn = block_length * model.tolerances.axis_rad / kReach_mm;
    out.push_back({u, u + block_length, is_timed, std::max(tip, min_tip) / time,
                   std::max(turn, min_turn) / time, is_timed ? time : 0});
    u += block_length;
  }
  return out;
}

/// The fastest that blocks about [u0, u1] allow tip and axis to be.
Asked fastest_about(const std::vector<Asked>& asked, double u0, double u1) {
  Asked out;
  bool has_tip_feed = false;
  const auto add_all = [&](double reach) {
    for (const Asked& block : asked) {
      if (block.end < u0 - reach || block.begin > u1 + reach) continue;
      out.is_timed |= block.is_timed;
      has_tip_feed |= reach == kPosition_mm && !block.is_timed;
      out.tip_mm_per_s = std::max(out.tip_mm_per_s, block.tip_mm_per_s);
      out.turn_rad_per_s = std::max(out.turn_rad_per_s, block.turn_rad_per_s);
    }
  };
  add_all(kPosition_mm);
  if (out.is_timed) add_all(kReach_mm + kPosition_mm);
  if (has_tip_feed) out.turn_rad_per_s = kNone;
  return out;
}

struct Speeds {
  double tip = 0, turn = 0;  ///< largest over what is allowed
  double tip_mm_per_s = 0;
  double duration_s = 0, min_s = 0;  ///< of the run, and the sum of block times
};

Speeds measure(const MachineModel& model, const std::vector<ClBlock>& blocks) {
  Speeds out;
  const JointVector start = joints_of(model, blocks[0]);
  const SmoothTrace trace = plan_smooth(model, blocks, start);
  EXPECT_EQ(trace.last.status, PlanStatus::kOk) << trace.last.reject.sequence;
  EXPECT_TRUE(std::isfinite(trace.duration_s()));
  if (testing::Test::HasFailure()) return out;
  std::vector<double> begin(trace.paths.size(), kNone);  // u where the path of a piece begins
  double u = 0;
  for (std::size_t n = 0; n < trace.paths.size(); ++n) {
    if (trace.times[n].kind != TimeKind::kMove || trace.paths[n].kind != PathKind::kSpline)
      continue;
    begin[n] = u;
    if (n + 1 == trace.paths.size() || trace.paths[n + 1].index != trace.paths[n].index) {
      u += trace.paths[n].length;
    }
    out.duration_s += trace.times[n].duration;
  }
  const auto asked = asked_by(blocks, model);
  EXPECT_NEAR(u, asked.back().end, kPosition_mm);
  for (const Asked& block : asked) out.min_s += block.min_s;
  const auto setpoints = sample(model, trace, kCycle_s, 0.37, start);
  for (std::size_t n = 1; n < setpoints.size(); ++n) {
    const PlanSample &from = setpoints[n - 1], &to = setpoints[n];
    const double u0 = begin[static_cast<std::size_t>(from.piece)] + from.s;
    const double u1 = begin[static_cast<std::size_t>(to.piece)] + to.s;
    if (!(u0 < u1 && u1 < kNone)) continue;
    const ToolPose a = forward(model, model.tool_length_mm, from.q);
    const ToolPose b = forward(model, model.tool_length_mm, to.q);
    const Asked largest = fastest_about(asked, u0, u1);
    const double tip = ((b.tip - a.tip).norm() - 1e-11) / kCycle_s;
    const double turn = angle_between(a.axis, b.axis) / kCycle_s - 1e-9;
    out.tip = std::max(out.tip, tip / std::min(largest.tip_mm_per_s, model.max_feed_mm_per_s));
    out.turn = std::max(out.turn, turn / largest.turn_rad_per_s);
    out.tip_mm_per_s = std::max(out.tip_mm_per_s, tip);
  }
  return out;
}

TEST(InverseTime, TipAndAxisAreNowhereFasterThanTheFastestBlockWithinReach) {
  const MachineModel model = quick_machine();
  const auto first = number_of<std::uint32_t>("MERIDIAN_INVERSE_SEED", 1);
  const auto count = number_of<std::uint32_t>("MERIDIAN_INVERSE_PROGRAMS", draws(4));
  Speeds all;
  for (std::uint32_t seed = first; seed < first + count; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Speeds one = measure(model, MixedTimes(seed).make(40));
    EXPECT_LE(one.tip, 1.0001);
    EXPECT_LE(one.turn, 1.0001);
    EXPECT_GE(one.duration_s, one.min_s) << "a block took less than its time";
    all.tip = std::max(all.tip, one.tip);
    all.turn = std::max(all.turn, one.turn);
    all.duration_s += one.duration_s;
    all.min_s += one.min_s;
  }
  std::printf(
      "%u programs from seed %u: tip %.4f, axis %.4f of the fastest block within reach, "
      "%.2f s for blocks of %.2f s\n",
      count, first, all.tip, all.turn, all.duration_s, all.min_s);
}

TEST(InverseTime, TheMachinesHighestFeedBoundsTheTipAllTheSame) {
  MachineModel model = quick_machine();
  model.max_feed_mm_per_s = 30;
  Speeds all;
  for (std::uint32_t seed = 1; seed <= draws(1); ++seed) {
    const Speeds one = measure(model, MixedTimes(seed).make(40));
    all.tip_mm_per_s = std::max(all.tip_mm_per_s, one.tip_mm_per_s);
  }
  EXPECT_LE(all.tip_mm_per_s, 30);
  EXPECT_GT(all.tip_mm_per_s, 29);
}

struct Streamed {
  SmoothTrace trace;
  std::size_t ahead = 0;  ///< pieces that were read before the last block came
};

/// What comes of a stream that pauses behind every `chunk` blocks: all that is ready is published
/// and read meanwhile, up to where the machine would run dry.
Streamed plan_in_chunks(const MachineModel& model, const std::vector<ClBlock>& blocks,
                        std::size_t chunk) {
  Streamed out;
  SmoothTrace& trace = out.trace;
  SmoothPlanner planner(model);
  planner.begin(joints_of(model, blocks[0]), model.tool_length_mm, 0, {Transition::kSmooth, 0, 0});
  planner.look_no_further();
  const auto port = std::make_unique<MotionPort>();
  MotionWriter writer(*port);
  PatientReader reader(*port);
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    out.ahead = trace.times.size();
    const auto is_taken = [&] {
      trace.last = planner.plan(blocks[n], writer);
      return trace.last.status != PlanStatus::kNoRoom;
    };
    for (int tries = 0; tries < 1000 && !is_taken(); ++tries) reader.read(trace, false);
    if (trace.last.status != PlanStatus::kOk) break;
    for (int pass = 0; (n + 1) % chunk == 0 && pass < 4; ++pass) {
      EXPECT_EQ(planner.advance(writer).status, PlanStatus::kOk);
      reader.read(trace, false);
    }
  }
  reader.read(trace, true);
  return out;
}

TEST(InverseTime, IsTheSameInHoweverManyChunksTheBlocksArrive) {
  const MachineModel model = quick_machine();
  const auto blocks = MixedTimes(1).make(12);
  const SmoothTrace once = plan_in_chunks(model, blocks, blocks.size()).trace;
  ASSERT_EQ(once.last.status, PlanStatus::kOk);
  EXPECT_EQ(once.times.back().kind, TimeKind::kEnd);
  for (const std::size_t chunk : {1U, 30U}) {
    const Streamed again = plan_in_chunks(model, blocks, chunk);
    EXPECT_TRUE(are_same(once, again.trace)) << "in chunks of " << chunk;
    EXPECT_GT(again.ahead, 100U) << "of " << once.times.size() << " pieces";
  }
}

}  // namespace
}  // namespace meridian::test::inverse_time
