// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "property/planner/random_programs.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/config/machine_file.hpp"
#include "support/draws.hpp"
#include "support/program_end.hpp"
#include "support/shipped_machines.hpp"

/// What is planned where a robot passes its singular places: joints inside their limits, or a
/// refusal.
namespace meridian::test {
namespace {

constexpr double kRounding = 1e-6;

class RobotPasses : public testing::TestWithParam<Transition> {};

/// The tool upright over the base axis of a robot that can reach behind it: along x, `beside_mm`
/// off the axis, in steps of 4 mm that end on the axis itself.
std::vector<ClBlock> over_the_base(double beside_mm) {
  constexpr int kBlocks = 30;
  std::vector<ClBlock> blocks;
  for (int n = 0; n <= kBlocks; ++n) {
    ClBlock block;
    block.kind = BlockKind::kCut;
    block.tip_mm = {4.0 * (kBlocks / 2 - n), beside_mm, 700};
    block.axis = {0, 0, 1};
    block.feed = 50;
    block.feed_meaning = FeedMeaning::kTip;
    block.sequence = static_cast<std::uint64_t>(n);
    block.line = static_cast<std::uint32_t>(n + 1);
    blocks.push_back(block);
  }
  end_program(blocks);
  return blocks;
}

MachineModel reaching_robot() {
  MachineModel robot = config::load_machine(shipped_file("robot-6r"));
  config::place_workpiece(robot, config::parse_frame("0,0,0"));
  for (const std::size_t joint : {robot::kYaw, robot::kShoulder}) {
    robot.joints[joint].limits.travel_min = units::rad_from_deg(-200);
    robot.joints[joint].limits.travel_max = units::rad_from_deg(200);
  }
  return robot;
}

/// Where the cycle comes to rest: the planner of a refused program does not say.
JointVector end_of(const MachineModel& model, const Trace& trace, JointVector joints) {
  for (std::size_t n = 0; n < trace.times.size(); ++n) {
    const TimePiece& piece = trace.times[n];
    if (piece.kind != TimeKind::kMove) continue;
    for (const double share : {0.5, 1.0}) {
      const double s = state_at(piece, share * piece.duration).s;
      joints = joints_at(model, trace.paths[n], s, joints).q;
    }
  }
  return joints;
}

TEST_P(RobotPasses, OverTheBaseAxisKeepTheLimitsOfEveryJoint) {
  const MachineModel robot = reaching_robot();
  for (const double beside_mm : {0.0, 1e-9, 1e-6, 1e-3, 0.1, 1.0, 30.0}) {
    SCOPED_TRACE(beside_mm);
    const auto blocks = over_the_base(beside_mm);
    const JointVector start = joints_of(robot, blocks[0]);
    SmoothTrace trace = plan_smooth(robot, blocks, start, {GetParam(), 0, 0}, true);
    trace.joints = end_of(robot, trace, start);
    const LimitUse use = measure_limits(robot, sample(robot, trace, 1e-3, 0.5, start), 1e-3);
    EXPECT_LT(std::max({use.v, use.a, use.j}), 1 + kRounding) << use.where;
    if (beside_mm > 20) {
      EXPECT_EQ(trace.last.status, PlanStatus::kOk);
    }
    if (GetParam() == Transition::kSmooth) {
      EXPECT_LT(trace.duration_s(), 60) << "it creeps";
    }
  }
}

/// A pass of the wrist's singular place: the tool sweeps through a pose with the bend at zero.
enum class Pass { kThrough, kOnto, kOff, kAlong };
constexpr Pass kPasses[] = {Pass::kThrough, Pass::kOnto, Pass::kOff, Pass::kAlong};
constexpr double kBeside_deg[] = {0, 1e-9, 1e-7, 1e-5, 1e-3, 0.01, 0.05, 0.1, 0.5, 1, 5};

class WristPass {
 public:
  WristPass(const MachineModel& robot, std::uint32_t seed) : robot_(robot), random_(seed) {
    at_ = {between(-0.9, 0.9), between(0.7, 1.4), between(-2.2, -1.2), between(-1.0, 1.0), 0, 0};
    pose_ = forward(robot, robot.tool_length_mm, at_);
    const Vector3 any{between(-1, 1), between(-1, 1), between(-1, 1)};
    spin_ = any.cross(pose_.axis).normalized();
    tip_ = between(0, 30) * Vector3(between(-1, 1), between(-1, 1), between(-1, 1));
    for (const int joint : {0, 1, 2, 3}) along_[joint] = between(-0.1, 0.1);
  }

  [[nodiscard]] std::vector<ClBlock> program(Pass pass, double beside_rad) const {
    constexpr int kBlocks = 30;
    std::vector<ClBlock> blocks;
    const int first = pass == Pass::kOff ? 0 : -kBlocks, last = pass == Pass::kOnto ? 0 : kBlocks;
    for (int n = first; n <= last; ++n) {
      const double share = 1.0 * n / kBlocks;
      const ToolPose pose = pass == Pass::kAlong ? beside_the_line(share, beside_rad)
                                                 : across_the_line(share, beside_rad);
      ClBlock block;
      block.kind = BlockKind::kCut;
      block.tip_mm = to_array(pose.tip);
      block.axis = to_array(pose.axis);
      block.feed = 50;
      block.feed_meaning = FeedMeaning::kTip;
      block.sequence = static_cast<std::uint64_t>(n - first);
      block.line = static_cast<std::uint32_t>(n - first + 1);
      blocks.push_back(block);
    }
    end_program(blocks);
    return blocks;
  }

 private:
  static constexpr double kSweep_rad = 0.17;
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  [[nodiscard]] ToolPose across_the_line(double share, double beside_rad) const {
    const double turn = share * kSweep_rad;
    const Vector3 on = std::cos(turn) * pose_.axis + std::sin(turn) * spin_.cross(pose_.axis);
    return {pose_.tip + share * tip_, (on + std::tan(beside_rad) * spin_).normalized()};
  }
  [[nodiscard]] ToolPose beside_the_line(double share, double beside_rad) const {
    JointVector q = at_;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += share * along_[i];
    q[robot::kBend] = beside_rad;
    return forward(robot_, robot_.tool_length_mm, q);
  }

  const MachineModel& robot_;
  std::mt19937 random_;
  JointVector at_{}, along_{};
  ToolPose pose_{Vector3::Zero(), Vector3::UnitZ()};
  Vector3 spin_, tip_;
};

double farthest_off(const MachineModel& model, const std::vector<ClBlock>& blocks,
                    const Trace& trace, const std::vector<PlanSample>& setpoints) {
  const auto ways = programmed_ways(blocks);
  double farthest = 0;
  for (std::size_t n = 3; n + 3 < setpoints.size(); n += 7) {
    const auto piece = static_cast<std::size_t>(setpoints[n].piece);
    const ToolPose pose = forward(model, model.tool_length_mm, setpoints[n].q);
    farthest =
        std::max(farthest, distance_from(ways, trace.times[piece].sequence, pose,
                                         model.tolerances.tip_mm, model.tolerances.axis_rad, 1.0));
  }
  return farthest;
}

TEST_P(RobotPasses, OfTheWristKeepLimitsAndTolerance) {
  const auto draws = number_of<std::uint32_t>("MERIDIAN_ROBOT_PASSES", 1);
  MachineModel robot = config::load_machine(shipped_file("robot-6r"));
  config::place_workpiece(robot, config::parse_frame("0,0,0"));
  int planned = 0, refused[std::size(kPasses)] = {};
  double slowest = 0;
  for (std::uint32_t seed = 1; seed <= draws; ++seed) {
    const WristPass wrist(robot, seed);
    for (const Pass pass : kPasses) {
      double time_beside = 0;
      for (std::size_t k = std::size(kBeside_deg); k-- > 0;) {
        const double beside_deg = kBeside_deg[k];
        SCOPED_TRACE(testing::Message() << "seed " << seed << " pass " << static_cast<int>(pass)
                                        << " beside " << beside_deg);
        const auto blocks = wrist.program(pass, units::rad_from_deg(beside_deg));
        const JointVector start = joints_of(robot, blocks[0]);
        SmoothTrace trace = plan_smooth(robot, blocks, start, {GetParam(), 0, 0}, true);
        trace.joints = end_of(robot, trace, start);
        const auto setpoints = sample(robot, trace, 1e-3, 0.5, start);
        const LimitUse use = measure_limits(robot, setpoints, 1e-3);
        EXPECT_LT(std::max({use.v, use.a, use.j}), 1 + kRounding) << use.where;
        EXPECT_LT(farthest_off(robot, blocks, trace, setpoints), 1 + kRounding);
        ++planned;
        if (trace.last.status == PlanStatus::kRefused) {
          ++refused[static_cast<std::size_t>(pass)];
          if (GetParam() == Transition::kSmooth) {  // half a turn of the roll may have no room
            EXPECT_EQ(trace.last.reject.code, RejectCode::kTravelBetween);
            EXPECT_EQ(trace.last.reject.joint, static_cast<int>(robot::kRoll));
            EXPECT_GT(beside_deg, 0.05);
          }
          continue;
        }
        if (beside_deg == 5) time_beside = trace.duration_s();
        if (time_beside > 0) slowest = std::max(slowest, trace.duration_s() / time_beside);
      }
    }
  }
  std::printf(
      "%d passes; refused through %d, onto %d, off %d, along %d; the slowest takes %.2f of "
      "the time at 5 deg beside\n",
      planned, refused[0], refused[1], refused[2], refused[3], slowest);
}

INSTANTIATE_TEST_SUITE_P(Every, RobotPasses,
                         testing::Values(Transition::kSmooth, Transition::kExactStop),
                         [](const testing::TestParamInfo<Transition>& transition) {
                           return transition.param == Transition::kSmooth ? "Smooth" : "ExactStop";
                         });

}  // namespace
}  // namespace meridian::test
