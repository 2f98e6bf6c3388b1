// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/path/path_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/path_piece.hpp"
#include "meridian/units.hpp"

namespace meridian::record {
namespace {

constexpr double kNudge = 1e-6;  // mm, rad
constexpr double kMinRate = 1e-9;

/// The path, and where it is one pose alone an element that stands there.
[[nodiscard]] std::vector<PathElement> elements_of(const CheckedPath& path) {
  if (!path.elements().empty()) return path.elements();
  PathElement still;
  still.tip_begin = path.begin().tip;
  still.tip_delta = still.arc_x = still.arc_y = still.axis_normal = Vector3::Zero();
  still.axis_begin = path.begin().axis;
  still.tool_length_mm = path.begin_tool_length_mm();
  return {still};
}

/// How far along the way the tool may be from where its pose is matched, mm.
[[nodiscard]] double reach_of_match(const CheckOptions& options) {
  return options.tip_tolerance_mm +
         kAxisLength_mm_per_rad * std::max(options.axis_tolerance_rad, options.pole_tolerance_rad);
}

}  // namespace

PathCheck::PathCheck(const MachineModel& model, const CheckedPath& path,
                     const CheckOptions& options)
    : model_(model),
      path_(path),
      options_(options),
      elements_(elements_of(path)),
      matching_(elements_),
      vertices_(path, options.tip_tolerance_mm),
      speeds_(model, path, options),
      times_(path, reach_of_match(options), static_cast<double>(model.cycle_ns) * 1e-9, options),
      creep_(model),
      tolerance_{options.tip_tolerance_mm, options.axis_tolerance_rad} {}

double PathCheck::axis_tolerance_at(const Vector3& axis) const noexcept {
  return pole_distance(model_, axis) < kPoleReach_rad ? options_.pole_tolerance_rad
                                                      : options_.axis_tolerance_rad;
}

double PathCheck::common_length(PathMatching::Position at) const noexcept {
  const PathElement& element = elements_[at.element];
  return element.s + at.t * element.length;
}

/// What the tool can have cut in the cycles that are missing before a sample.
PathMatching::Gap PathCheck::gap_before(const Sample& at) const {
  PathMatching::Gap gap;
  gap.time_s = static_cast<double>(at.missing + 1) * static_cast<double>(model_.cycle_ns) * 1e-9;
  gap.factor = options_.max_feed_factor();
  gap.fastest_mm_per_s = gap.fastest_rad_per_s = kMinRate;
  const double length = elements_[matching_.lowest().element].tool_length_mm;
  const ToolPose pose = forward(model_, length, at.joints);
  for (int i = 0; i < model_.joint_count; ++i) {
    JointVector nudged = at.joints;
    nudged[i] += kNudge;
    const ToolPose other = forward(model_, length, nudged);
    const double per_unit = model_.joints[i].limits.velocity / kNudge;
    gap.fastest_mm_per_s += per_unit * (other.tip - pose.tip).norm();
    gap.fastest_rad_per_s += per_unit * (other.axis - pose.axis).norm();
  }
  return gap;
}

/// Takes the matching on to a pose: a setpoint, or one on the way to it.
void PathCheck::match(const JointVector& joints, const Sample& at, bool is_setpoint) {
  const ToolPose gauge = true_pose(model_, 0, joints);
  tolerance_.axis_rad = axis_tolerance_at(gauge.axis);
  const GaugePose pose{gauge.tip, gauge.axis};
  const auto step = is_setpoint && at.missing > 0
                        ? matching_.cross(pose, tolerance_, gap_before(at))
                        : matching_.move(pose, tolerance_);
  note(step, at, is_setpoint);
  vertices_.add(matching_.passed());
  matching_.passed().clear();
}

/// A tool that leaves the path for an element farther ahead has missed what lies between; that it
/// went off the element before is no finding of its own, unless it was nowhere near.
void PathCheck::note(PathMatching::Step step, const Sample& at, bool is_setpoint) {
  using enum PathMatching::Step;
  if (step != kWithin && broken_.value == 0) broken_ = {1, at.cycle, at.line};
  if (step == kWidened && last_step_ != kWidened && last_step_ != kAstray) before_ = now_;
  if (step == kResumed && last_step_ == kWidened) now_ = before_;
  last_step_ = step == kWidened && last_step_ == kAstray ? kAstray : step;
  const PoseMatch match = matching_.best();
  (is_setpoint ? now_.tip : now_.tip_between).raise(match.tip_mm, at.cycle, at.line);
  (is_setpoint ? now_.axis : now_.axis_between).raise(match.axis_rad, at.cycle, at.line);
  if (match.tip_mm > tolerance_.tip_mm * (1 + 2 * kRoundingShare)) {
    now_.tip_over.worst.raise(match.tip_mm, at.cycle, at.line);
    now_.tip_over.count += is_setpoint ? 1 : 0;
  }
  if (match.axis_rad > tolerance_.axis_rad * (1 + 2 * kRoundingShare)) {
    if (match.axis_rad > now_.axis_over.worst.value) now_.exceeded_axis = tolerance_.axis_rad;
    now_.axis_over.worst.raise(match.axis_rad, at.cycle, at.line);
    now_.axis_over.count += is_setpoint ? 1 : 0;
  }
}

/// Plan time per time while the program runs; of a recording without plan time 1 where joints move.
double PathCheck::rate_between(const Sample& from, const Sample& to) const noexcept {
  if (!to.is_running) return 0;
  if (!(to.plan_time_s > 0)) return from.joints == to.joints ? 0 : 1;
  const double period = static_cast<double>(model_.cycle_ns) * 1e-9;
  return std::clamp((to.plan_time_s - from.plan_time_s) / period, 0.0, 1.0);
}

void PathCheck::compare_speeds(const Sample& from, const Sample& to, PathMatching::Position low) {
  const double length = elements_[low.element].tool_length_mm;
  const ToolPose begin = forward(model_, length, from.joints);
  const ToolPose end = forward(model_, length, to.joints);
  speeds_.add(begin, end, low, matching_.highest(), to.cycle, to.line);
  if (path_.elements().empty()) return;
  creep_.add({from.joints, to.joints, (end.tip - begin.tip).norm(),
              speeds_.feed_between(low, matching_.highest()),
              matching_.lowest().element - low.element, rate_between(from, to)},
             to.cycle, to.line);
}

/// Goes from the last but one sample to the last: between them first, where four say how.
void PathCheck::step(bool has_between) {
  const Sample& from = samples_[1];
  const Sample& to = samples_[2];
  const bool is_next = to.cycle == from.cycle + 1;
  const bool is_rest = from.joints == to.joints && samples_[0].joints == from.joints &&
                       samples_[3].joints == to.joints;
  if (is_rest && is_next && rate_between(from, to) == 0) return;
  const PathMatching::Position low = matching_.lowest();
  if (has_between && !is_rest) {
    for (const double x : {0.25, 0.5, 0.75}) {
      JointVector q{};
      for (int i = 0; i < model_.joint_count; ++i) {
        q[i] = -x * (x - 1) * (x - 2) / 6 * samples_[0].joints[i] +
               (x + 1) * (x - 1) * (x - 2) / 2 * from.joints[i] -
               (x + 1) * x * (x - 2) / 2 * to.joints[i] +
               (x + 1) * x * (x - 1) / 6 * samples_[3].joints[i];
      }
      match(q, from, false);
    }
  }
  match(to.joints, to, true);
  if (!path_.elements().empty()) {
    const auto path_to = [this](PathMatching::Position at) {
      return elements_[at.element].path_to(at.t);
    };
    times_.add(path_to(matching_.highest()), path_to(matching_.lowest()), to.cycle);
  }
  if (is_next) compare_speeds(from, to, low);
}

void PathCheck::add(const RecordingRow& row, std::uint64_t missing) {
  const bool is_next = known_ > 0 && row.cycle == samples_[3].cycle + 1;
  std::rotate(samples_.begin(), samples_.begin() + 1, samples_.end());
  samples_[3] = {row.cycle,       row.line,
                 row.joints,      known_ > 0 ? missing : 0,
                 row.plan_time_s, row.state == State::kRunning};
  run_ = is_next ? std::min(run_ + 1, 4) : 1;
  known_ = std::min(known_ + 1, 4);
  if (known_ == 1) {
    match(row.joints, samples_[3], true);
  } else if (known_ == 3) {
    samples_[0] = samples_[1];
    step(false);
  } else if (known_ == 4) {
    step(run_ == 4);
  }
}

void PathCheck::finish(CheckReport& report) {
  if (known_ > 1) {  // the last sample has none behind it
    std::rotate(samples_.begin(), samples_.begin() + 1, samples_.end());
    samples_[3] = samples_[2];
    if (known_ == 2) samples_[0] = samples_[1];
    step(false);
  }
  const bool is_at_end = matching_.finish();
  vertices_.add(matching_.passed());
  vertices_.add_last(matching_.open());
  report.tip_mm = now_.tip;
  report.axis_rad = now_.axis;
  report.tip_between_mm = now_.tip_between;
  report.axis_between_rad = now_.axis_between;
  find_deviations(report);
  speeds_.finish(report);
  times_.finish(report);
  creep_.finish(report);
  vertices_.finish(report);
  find_disorder(report, is_at_end);
}

void PathCheck::find_deviations(CheckReport& report) const {
  char text[256];
  const auto find = [&](Finding::Kind kind, const Excess& excess) {
    report.findings.push_back({kind, text, excess.worst.cycle, excess.worst.line, excess.count});
  };
  if (now_.tip_over.worst.value > 0) {
    std::snprintf(text, sizeof text, "tip is %.6f mm off the path, tolerance %.6g mm",
                  now_.tip_over.worst.value, options_.tip_tolerance_mm);
    find(Finding::Kind::kTip, now_.tip_over);
  }
  if (now_.axis_over.worst.value > 0) {
    std::snprintf(text, sizeof text, "tool axis is %.6f deg off the path, tolerance %.6g deg",
                  units::deg_from_rad(now_.axis_over.worst.value),
                  units::deg_from_rad(now_.exceeded_axis));
    find(Finding::Kind::kAxis, now_.axis_over);
  }
}

/// Whether the path was cut to its end, and in its order: who is always somewhere on the path may
/// still have cut it in another one.
void PathCheck::find_disorder(CheckReport& report, bool is_at_end) const {
  char text[256];
  const std::span<const VertexPass> open = matching_.open();
  const bool has_seen_end = is_at_end || (matching_.is_broken() && !open.empty() &&
                                          open.back().index == elements_.size() &&
                                          open.back().share <= 1 + 2 * kRoundingShare);
  if (!has_seen_end && !options_.allow_unfinished) {
    std::snprintf(text, sizeof text, "the path was cut to %.3f of %.3f mm of its common length",
                  common_length(matching_.highest()), path_.length());
    report.findings.push_back(
        {Finding::Kind::kUnfinished, text, samples_.back().cycle, samples_.back().line, 1});
  }
  const auto is_of_path = [](const Finding& finding) {
    return finding.kind == Finding::Kind::kTip || finding.kind == Finding::Kind::kAxis ||
           finding.kind == Finding::Kind::kVertex || finding.kind == Finding::Kind::kUnfinished;
  };
  if (!matching_.is_broken() ||
      std::any_of(report.findings.begin(), report.findings.end(), is_of_path)) {
    return;
  }
  report.findings.push_back({Finding::Kind::kOrder,
                             "from here on the path is cut in another order than it is programmed",
                             broken_.cycle, broken_.line, 1});
}

}  // namespace meridian::record
