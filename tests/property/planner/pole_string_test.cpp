// SPDX-License-Identifier: Apache-2.0

/// Drawn paths beside the pole against the least time that their corridor has with feed and the
/// redundant joint's speed alone.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "property/planner/smooth_trace.hpp"
#include "service/core/planner/singular/pole/taut_string.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::pole_string {
namespace {

constexpr double kFeed_mm_per_s = 50;
constexpr double kTolerance_rad = 0.1 * units::kDegree_rad;

constexpr double kFar_rad = 0.3;
constexpr double kMore = 0.08;           // of the least time
constexpr unsigned kPathsOfAShare = 50;  // fewer, as under sanitizers, have no share to speak of

/// The axis seen along the pole.
struct Lean {
  double x = 0, y = 0;
};

/// A straight path of the tip, an axis at every block's end.
struct Draw {
  std::vector<Lean> axes;
  double step_mm = 1;
};

std::vector<ClBlock> program_of(const Draw& draw, double off_rad) {
  std::vector<ClBlock> out;
  for (const Lean& lean : draw.axes) {
    ClBlock block;
    block.sequence = out.size();
    block.line = 10 + static_cast<std::uint32_t>(out.size());
    block.tip_mm = {draw.step_mm * static_cast<double>(out.size()), 20, 30};
    block.axis = to_array(Vector3(lean.x + off_rad, lean.y, 1).normalized());
    block.feed = kFeed_mm_per_s;
    block.feed_meaning = FeedMeaning::kTip;
    out.push_back(block);
  }
  end_program(out);
  return out;
}

/// Wavering, past, about, or wandering beside the pole, as far as a few tolerances.
Draw drawn(std::uint32_t seed) {
  std::mt19937 engine(seed);
  const auto uniform = [&engine](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  Draw draw;
  draw.step_mm = uniform(0.3, 1.5);
  const int blocks = static_cast<int>(uniform(40, 80) / draw.step_mm);
  const double size = kTolerance_rad * std::pow(10.0, uniform(-0.7, 0.4));
  const double turned = uniform(-3, 3), rate = uniform(0.1, 0.8) * units::kDegree_rad;
  const double bend = uniform(-1, 1);
  Lean at;
  for (int n = 0; n < blocks; ++n) {
    const double s = (n - 0.5 * blocks) * draw.step_mm;
    switch (seed % 4) {
      case 0:
        at = {size * uniform(-1, 1), size * uniform(-1, 1)};
        break;
      case 1:
        at = {rate * s, size + (s > 0 ? bend * rate * s : 0)};
        break;
      case 2:
        at = {size * std::cos(s / 8), size * std::sin(s / 8)};
        break;
      default:
        at.x += 0.3 * size * uniform(-1, 1) - 0.05 * at.x;
        at.y += 0.3 * size * uniform(-1, 1) - 0.05 * at.y;
    }
    draw.axes.push_back({std::cos(turned) * at.x - std::sin(turned) * at.y,
                         std::sin(turned) * at.x + std::cos(turned) * at.y});
  }
  return draw;
}

/// The corridor of the redundant joint along a way, by the programmed axes alone, and the least
/// time through it with feed and the joint's speed alone: the string, on the best sides of its
/// walls.
class MinTime {
 public:
  MinTime(const Draw& draw, double speed) : speed_(speed) {
    add(0, draw.axes[0]);
    for (std::size_t n = 1; n < draw.axes.size(); ++n) {
      const Lean &a = draw.axes[n - 1], &b = draw.axes[n];
      const int parts =
          4 + static_cast<int>(std::hypot(b.x - a.x, b.y - a.y) / (0.1 * kTolerance_rad));
      for (int k = 1; k <= parts; ++k) {
        const double share = 1.0 * k / parts;
        add(draw.step_mm / kFeed_mm_per_s / parts,
            {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)});
      }
    }
    phi_.front().is_wall = true;  // the machine is approached by the azimuth of the first block
  }

  double find() {
    std::vector<Course> beam{{0, {}}};
    std::vector<std::size_t> begins;
    for (std::size_t n = 0; n < phi_.size(); ++n) {
      if (phi_[n].is_wall && (n == 0 || !phi_[n - 1].is_wall)) begins.push_back(n);
    }
    for (std::size_t i = 0; i < begins.size(); ++i) {
      const std::size_t end = i + 1 < begins.size() ? begins[i + 1] : phi_.size();
      std::vector<Course> found;
      for (const Course& course : beam) {
        const int last = course.sides.empty() ? 0 : course.sides.back();
        for (int side = i == 0 ? 0 : last - 3; side <= (i == 0 ? 0 : last + 3); ++side) {
          Course next = course;
          next.sides.push_back(side);
          next.time = time_of(next.sides, begins, end);
          found.push_back(next);
        }
      }
      std::sort(found.begin(), found.end(),
                [](const Course& a, const Course& b) { return a.time < b.time; });
      found.resize(std::min<std::size_t>(found.size(), 24));
      beam = found;
    }
    return beam.front().time;
  }

 private:
  struct Sample {
    double t = 0, azimuth = 0, half = 0;
    bool is_wall = false;
  };
  struct Course {
    double time = 0;
    std::vector<int> sides;
  };

  void add(double dt, const Lean& at) {
    const double rho = std::hypot(at.x, at.y), phi = std::atan2(at.y, at.x);
    const double before = phi_.empty() ? phi : phi_.back().azimuth;
    Sample node;
    node.t = phi_.empty() ? 0 : phi_.back().t + dt;
    node.azimuth = before + std::remainder(phi - before, 2 * std::numbers::pi);
    node.is_wall = rho > kTolerance_rad;
    node.half = node.is_wall ? std::asin(kTolerance_rad / rho) : 0;
    phi_.push_back(node);
  }

  [[nodiscard]] double time_of(const std::vector<int>& sides,
                               const std::vector<std::size_t>& begins, std::size_t end) {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    windows_.clear();
    values_.resize(end);
    std::size_t wall = 0;
    for (std::size_t n = 0; n < end; ++n) {
      while (wall + 1 < begins.size() && begins[wall + 1] <= n) ++wall;
      const Sample& node = phi_[n];
      const double middle =
          node.azimuth + std::numbers::pi * sides[std::min(wall, sides.size() - 1)];
      windows_.push_back(node.is_wall && wall < sides.size()
                             ? StringWindow{node.t, middle - node.half, middle + node.half}
                             : StringWindow{node.t, -kAny, kAny});
    }
    pull_taut(windows_, phi_.front().azimuth, values_);
    double time = 0;
    for (std::size_t n = 1; n < end; ++n) {
      time += std::max(windows_[n].t - windows_[n - 1].t,
                       std::abs(values_[n] - values_[n - 1]) / speed_);
    }
    return time;
  }

  double speed_;
  std::vector<Sample> phi_;
  std::vector<StringWindow> windows_;
  std::vector<double> values_;
};

SmoothTrace cut(const MachineModel& model, const std::vector<ClBlock>& blocks) {
  return plan_smooth(model, blocks, joints_of(model, blocks[0]));
}

/// Of limits, and of the tolerance about the programmed way.
void check(const MachineModel& model, const std::vector<ClBlock>& blocks,
           const SmoothTrace& trace) {
  const auto setpoints = sample(model, trace, 1e-3, 0.37, joints_of(model, blocks[0]));
  const LimitUse use = measure_limits(model, setpoints, 1e-3);
  EXPECT_LE(std::max({use.v, use.a, use.j}), 1 + 1e-6) << use.where;
  const auto programmed = programmed_paths(blocks);
  for (std::size_t n = 3; n + 3 < setpoints.size(); n += 17) {
    const auto k = static_cast<std::size_t>(setpoints[n].piece);
    if (trace.times[k].kind != TimeKind::kMove) continue;
    const ToolPose pose = forward(model, trace.paths[k].tool_length_mm, setpoints[n].q);
    EXPECT_LE(distance_from(programmed, trace.times[k].sequence, pose, model.tolerances.tip_mm,
                            model.tolerances.axis_rad),
              1 + 1e-6)
        << "block " << trace.times[k].sequence;
  }
}

/// The ramps: what the same way takes beyond its feed far off the pole, where the feed has no other
/// bound, and where the redundant joint has to turn also one of that from rest to its speed and
/// back. The least time knows nothing of smoothing: where that closes a gate which the programmed
/// axes leave open by a hair the way round is far longer, hence a share of the paths beside a mean.
TEST(PoleString, TakesLittleMoreThanTheLeastTimeOfTheCorridor) {
  const auto paths = number_of("MERIDIAN_STRING_PATHS", static_cast<unsigned>(draws(100)));
  const auto first = number_of("MERIDIAN_STRING_SEED", 1U);
  const MachineModel model = lai_machine();
  double worst = 0, sum = 0;
  unsigned far = 0;
  for (std::uint32_t seed = first; seed < first + paths; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Draw draw = drawn(seed);
    const double feed_s = draw.step_mm * static_cast<double>(draw.axes.size() - 1) / kFeed_mm_per_s;
    const JointLimits& limits = model.joints[redundant_joint(model)].limits;
    const double string_s = MinTime(draw, limits.velocity).find();
    const double off_s = cut(model, program_of(draw, kFar_rad)).duration_s();
    const double turn_s = limits.velocity / limits.acceleration + limits.acceleration / limits.jerk;
    const double ramps_s = off_s - feed_s + (string_s > 1.01 * feed_s ? turn_s : 0);
    const double min_s = string_s + ramps_s;
    const auto blocks = program_of(draw, 0);
    const SmoothTrace trace = cut(model, blocks);
    ASSERT_EQ(trace.last.status, PlanStatus::kOk) << static_cast<int>(trace.last.reject.code);
    if (seed % 4 == 1) check(model, blocks, trace);
    const double more = trace.duration_s() / min_s - 1;
    if (more > kMore) {
      ++far;
      std::printf("seed %u: %.3f s, least %.3f s, feed %.3f s, ramps %.3f s\n", seed,
                  trace.duration_s(), min_s, feed_s, ramps_s);
    }
    worst = std::max(worst, more);
    sum += more;
  }
  std::printf("%u paths: %.2f %% above on average, %u more than 8 %%, at most %.0f %%\n", paths,
              100 * sum / paths, far, 100 * worst);
  if (paths < kPathsOfAShare) return;
  EXPECT_LT(sum / paths, 0.1);
  EXPECT_LE(far, paths / 5);
}

/// The axis at random inside the tolerance, at every block another: on the pole all the time.
TEST(PoleString, AnAxisThatWaversInsideItsToleranceTakesTheTimeOfOneOnThePole) {
  const MachineModel model = lai_machine();
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> share(-1, 1);
    Draw on_pole, wavers;
    on_pole.step_mm = wavers.step_mm = 0.5;
    on_pole.axes.resize(draws(200));
    for (std::size_t n = 0; n < on_pole.axes.size(); ++n) {
      const double size = 0.9 * kTolerance_rad / std::sqrt(2.0), x = size * share(engine);
      wavers.axes.push_back({x, size * share(engine)});
    }
    const double on_pole_s = cut(model, program_of(on_pole, 0)).duration_s();
    const SmoothTrace trace = cut(model, program_of(wavers, 0));
    ASSERT_EQ(trace.last.status, PlanStatus::kOk);
    check(model, program_of(wavers, 0), trace);
    std::printf("wavers inside 0.9 tolerances: %.3f s, on the pole %.3f s\n", trace.duration_s(),
                on_pole_s);
    EXPECT_LT(trace.duration_s(), 1.06 * on_pole_s);
  }
}

TEST(PoleString, IsNeverSlowerThanTheExactPolicy) {
  const MachineModel relaxed = bench_machine();
  MachineModel exact = relaxed;
  exact.pole_policy = PolePolicy::kExact;
  for (std::uint32_t seed = 1; seed <= static_cast<unsigned>(draws(16)); seed += 4) {
    const auto blocks = program_of(drawn(seed), 0);
    const SmoothTrace there = cut(exact, blocks);
    ASSERT_EQ(there.last.status, PlanStatus::kOk);
    EXPECT_LT(cut(relaxed, blocks).duration_s(), 1.01 * there.duration_s()) << "seed " << seed;
  }
}

}  // namespace
}  // namespace meridian::test::pole_string
