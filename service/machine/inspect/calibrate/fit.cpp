// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/calibrate/fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "meridian/kinematics/keep_out.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/tip_over_base.hpp"

namespace meridian::inspect {
namespace {

constexpr double kOutOfReach = -1;  // and a share of the program more

/// Range of a joint or drive over a program, in the winding that leaves most room.
struct Range {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  std::uint32_t min_line = 0, max_line = 0;
  double winding = 0;  ///< whole turns that were added

  void add(double q, std::uint32_t line) {
    if (q < min) {
      min = q;
      min_line = line;
    }
    if (q > max) {
      max = q;
      max_line = line;
    }
  }

  void wind_into(const JointSpec& joint) {
    if (!joint.is_rotary || joint.is_endless) return;
    constexpr double kTurn = 2 * std::numbers::pi;
    const double off =
        0.5 * (joint.limits.travel_min + joint.limits.travel_max) - 0.5 * (min + max);
    winding = kTurn * std::round(off / kTurn);
    min += winding;
    max += winding;
  }
};

/// What is left to the nearer end of travel, as a share of half of it.
struct Room {
  double share = 1;
  std::uint32_t line = 0;
};

Room room_of(const JointLimits& limits, const Range& range) {
  const double half = 0.5 * (limits.travel_max - limits.travel_min);
  const double below = (range.min - limits.travel_min) / half;
  const double above = (limits.travel_max - range.max) / half;
  return below < above ? Room{below, range.min_line} : Room{above, range.max_line};
}

/// A pose of a program with the joints that reach it.
struct Followed {
  const ProgramPose* pose = nullptr;
  JointVector q{};
};

/// A program on one branch.
struct Course {
  std::vector<Followed> reached;
  std::vector<const ProgramPose*> out_of_reach;
  std::array<Range, kMaxLimited> range;
};

Course follow(const MachineModel& model, const std::vector<ProgramPose>& poses, int branch) {
  Course course;
  course.reached.reserve(poses.size());
  JointVector q{};
  for (int i = 0; i < model.joint_count; ++i) q[i] = model.joints[i].home;
  for (const ProgramPose& at : poses) {
    const auto solution = solve(model, at.tool_length_mm, at.pose, branch, q);
    if (solution.status == SolveStatus::kUnreachable) {
      course.out_of_reach.push_back(&at);
      continue;
    }
    q = solution.q;
    course.reached.push_back({&at, q});
    const LimitedVector all = limited_of(model, q);
    for (int i = 0; i < limited_count(model); ++i) {
      course.range[static_cast<std::size_t>(i)].add(all[i], at.line);
    }
  }
  for (int i = 0; i < limited_count(model); ++i) {
    course.range[static_cast<std::size_t>(i)].wind_into(limited_spec(model, i));
  }
  return course;
}

JointVector wound(const Course& course, const JointVector& q) {
  JointVector out = q;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += course.range[i].winding;
  return out;
}

/// The keep-out box that the joints are in at pose `n`, or pass on the straight way to it; -1:
/// none. `depth` is how deep they are inside.
int box_at(const MachineModel& model, const Course& course, std::size_t n, double& depth) {
  const JointVector q = wound(course, course.reached[n].q);
  const JointVector before = n > 0 ? wound(course, course.reached[n - 1].q) : q;
  const int inside = keep_out_at(model.keep_out, q);
  depth = 0;
  if (inside < 0) return keep_out_between(model.keep_out, before, q).box;
  depth = depth_inside(model.keep_out.boxes()[static_cast<std::size_t>(inside)], q);
  return inside;
}

/// Puts into `fit` the box that the joints are in deepest, if they enter one.
void look_for_boxes(const MachineModel& model, const Course& course, Fit& fit) {
  if (model.keep_out.empty()) return;
  constexpr double kEntered = 1e-3, kDeepest = 1e3;  // share of half travel; mm or rad
  double deepest = -1;
  for (std::size_t n = 0; n < course.reached.size(); ++n) {
    double depth = 0;
    const int box = box_at(model, course, n, depth);
    if (box < 0 || depth <= deepest) continue;
    deepest = depth;
    fit.box = box;
    fit.joint = -1;
    fit.line = course.reached[n].pose->line;
  }
  if (fit.box < 0) return;
  const double margin = -kEntered - std::min(deepest / kDeepest, 0.9);
  fit.margin = std::min(fit.margin, margin);
}

/// How far the tip is outside of its box along the axis where that is farthest; not positive
/// inside.
struct TipBeyond {
  int axis = 0;
  double by_mm = -std::numeric_limits<double>::infinity();
};

TipBeyond tip_beyond(const MachineModel& model, const Followed& at) {
  TipBeyond out;
  const Array3 tip = tip_over_base(model, at.pose->tool_length_mm, at.q);
  for (std::size_t i = 0; i < tip.size(); ++i) {
    const double by = beyond_face(model.tip_box, i, tip[i]);
    if (by > out.by_mm) out = {static_cast<int>(i), by};
  }
  return out;
}

/// Puts into `fit` where the tip is farthest outside of its box, if it is.
void look_for_tip(const MachineModel& model, const Course& course, Fit& fit) {
  if (!model.tip_box.is_set) return;
  constexpr double kLeft = 1e-3, kFarthest_mm = 1e4;  // share of half travel
  double farthest = kTipBoxRounding;
  for (const Followed& at : course.reached) {
    const TipBeyond beyond = tip_beyond(model, at);
    if (beyond.by_mm <= farthest) continue;
    farthest = beyond.by_mm;
    fit.tip_axis = beyond.axis;
    fit.line = at.pose->line;
  }
  if (fit.tip_axis < 0) return;
  fit.joint = fit.box = -1;
  fit.margin = std::min(fit.margin, -kLeft - std::min(farthest / kFarthest_mm, 0.9));
}

/// The time of a program by feeds, and velocities and accelerations of joints and drives.
class TimeEstimate {
 public:
  explicit TimeEstimate(const MachineModel& model) : model_(model) {}

  void add(const LimitedVector& q, double feed_time_s) {
    if (!before_) {
      before_ = q;
      return;
    }
    Step step;
    step.time_s = feed_time_s;
    for (int i = 0; i < limited_count(model_); ++i) {
      step.by[i] = q[i] - (*before_)[i];
      step.time_s =
          std::max(step.time_s, std::abs(step.by[i]) / limited_spec(model_, i).limits.velocity);
    }
    before_ = q;
    if (step.time_s < kShortest_s) return;
    const double stretch = stretch_between(last_, step);
    total_s_ += last_.time_s * std::max(last_.stretch, stretch);
    last_ = step;
    last_.stretch = stretch;
  }

  [[nodiscard]] double total_s() const { return total_s_ + last_.time_s * last_.stretch; }

 private:
  static constexpr double kShortest_s = 1e-6;

  struct Step {
    LimitedVector by{};
    double time_s = 0, stretch = 1;
  };

  /// By how much two steps must take longer for the change of velocity between them.
  [[nodiscard]] double stretch_between(const Step& a, const Step& b) const {
    if (a.time_s == 0) return 1;
    double largest = 1;
    for (int i = 0; i < limited_count(model_); ++i) {
      const double change = std::abs(b.by[i] / b.time_s - a.by[i] / a.time_s);
      const double allowed =
          limited_spec(model_, i).limits.acceleration * 0.5 * (a.time_s + b.time_s);
      largest = std::max(largest, change / allowed);
    }
    return std::sqrt(largest);
  }

  const MachineModel& model_;
  std::optional<LimitedVector> before_;
  Step last_;
  double total_s_ = 0;
};

Fit fit_on(const MachineModel& model, const std::vector<ProgramPose>& poses, int branch) {
  const Course course = follow(model, poses, branch);
  Fit fit;
  fit.branch = branch;
  if (!course.out_of_reach.empty()) {
    fit.line = course.out_of_reach.front()->line;
    fit.margin = kOutOfReach - static_cast<double>(course.out_of_reach.size()) /
                                   static_cast<double>(poses.size());
    fit.score = fit.margin;
    return fit;
  }
  constexpr double kOfMean = 0.01;
  double sum = 0;
  fit.margin = 1;
  for (int i = 0; i < limited_count(model); ++i) {
    const Range& range = course.range[static_cast<std::size_t>(i)];
    const JointSpec& joint = limited_spec(model, i);
    fit.min[i] = range.min;
    fit.max[i] = range.max;
    if (joint.is_endless) continue;
    const Room room = room_of(joint.limits, range);
    sum += room.share;
    if (room.share >= fit.margin) continue;
    fit.margin = std::max(room.share, -0.999);
    fit.joint = i;
    fit.line = room.line;
  }
  look_for_boxes(model, course, fit);
  look_for_tip(model, course, fit);
  fit.score = fit.margin + kOfMean * sum / limited_count(model);
  return fit;
}

/// Counts the lines that an obstacle is in the way of.
class Findings {
 public:
  void add(Obstacle obstacle, int number, double by, std::uint32_t line) {
    const auto same = [&](const FitFinding& known) {
      return known.obstacle == obstacle && known.number == number;
    };
    auto at = std::find_if(found_.begin(), found_.end(), same);
    if (at == found_.end()) at = found_.insert(at, {obstacle, number, by, line, line, 0, 0});
    if (at->lines == 0 || at->last_line != line) ++at->lines;
    at->last_line = line;
    if (by <= at->farthest) return;
    at->farthest = by;
    at->farthest_line = line;
  }

  [[nodiscard]] std::vector<FitFinding> in_order() && {
    const auto key = [](const FitFinding& one) {
      const bool is_travel =
          one.obstacle == Obstacle::kTravelMin || one.obstacle == Obstacle::kTravelMax;
      const int group = one.obstacle == Obstacle::kOutOfReach ? 0
                        : is_travel                           ? 1
                        : one.obstacle == Obstacle::kKeepOut  ? 2
                                                              : 3;
      return std::tuple(group, one.number, one.obstacle);
    };
    std::ranges::stable_sort(found_, {}, key);
    return std::move(found_);
  }

 private:
  std::vector<FitFinding> found_;
};

}  // namespace

Fit fit_of(const MachineModel& model, const std::vector<ProgramPose>& poses) {
  Fit best;
  for (int branch = 0; branch < branch_count(model); ++branch) {
    const Fit fit = fit_on(model, poses, branch);
    if (branch == 0 || fit.score > best.score) best = fit;
  }
  return best;
}

double estimated_time_s(const MachineModel& model, const std::vector<ProgramPose>& poses,
                        int branch) {
  TimeEstimate time(model);
  for (const Followed& at : follow(model, poses, branch).reached) {
    time.add(limited_of(model, at.q), at.pose->feed_time_s);
  }
  return time.total_s();
}

std::vector<FitFinding> findings_of(const MachineModel& model,
                                    const std::vector<ProgramPose>& poses, int branch) {
  const Course course = follow(model, poses, branch);
  Findings findings;
  for (const ProgramPose* const at : course.out_of_reach) {
    findings.add(Obstacle::kOutOfReach, 0, 0, at->line);
  }
  for (std::size_t n = 0; n < course.reached.size(); ++n) {
    const Followed& at = course.reached[n];
    const LimitedVector all = limited_of(model, at.q);
    for (int i = 0; i < limited_count(model); ++i) {
      const JointSpec& joint = limited_spec(model, i);
      if (joint.is_endless) continue;
      const double q = all[i] + course.range[static_cast<std::size_t>(i)].winding;
      const double below = joint.limits.travel_min - q, above = q - joint.limits.travel_max;
      if (below > 0) findings.add(Obstacle::kTravelMin, i, below, at.pose->line);
      if (above > 0) findings.add(Obstacle::kTravelMax, i, above, at.pose->line);
    }
    double depth = 0;
    const int box = model.keep_out.empty() ? -1 : box_at(model, course, n, depth);
    if (box >= 0) findings.add(Obstacle::kKeepOut, box, depth, at.pose->line);
    const TipBeyond tip = model.tip_box.is_set ? tip_beyond(model, at) : TipBeyond{};
    if (tip.by_mm > kTipBoxRounding) {
      findings.add(Obstacle::kTipBox, tip.axis, tip.by_mm, at.pose->line);
    }
  }
  return std::move(findings).in_order();
}

}  // namespace meridian::inspect
