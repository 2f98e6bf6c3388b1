// SPDX-License-Identifier: Apache-2.0
#include "service/record/path_judge.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"

namespace meridian::record {
namespace {

constexpr double kRoundingShare = 1e-6;
constexpr double kPlace_mm = 1e-11;   // of the tip, by rounding of the joints
constexpr double kLeastFeed = 1e-12;  // mm/s

/// A vertex is looked for this far before and behind the place where the tool is.
constexpr double kVertexMargin_mm = 0.1;
/// A chord between samples cuts no more than this off a smooth way.
constexpr double kLargestSag_mm = 1e-4;

/// How long the rate of plan time takes at most to follow an override: its ramp, and what it needs
/// to turn round, get going and settle.
[[nodiscard]] std::uint64_t ramp_cycles(const MachineModel& model) {
  constexpr double kSettle_s = 0.3;
  return static_cast<std::uint64_t>(1e9 * (model.override_ramp_s + kSettle_s)) /
         static_cast<std::uint64_t>(model.cycle_ns);
}

[[nodiscard]] double distance_to_chord(const Vector3& point, const Vector3& a, const Vector3& b) {
  const Vector3 d = b - a;
  const double square = d.squaredNorm();
  const double t = square > 0 ? std::clamp((point - a).dot(d) / square, 0.0, 1.0) : 0.0;
  return (a + t * d - point).norm();
}

}  // namespace

PathJudge::PathJudge(const MachineModel& model, const CheckedPath& path,
                     const CheckOptions& options)
    : model_(model),
      path_(path),
      options_(options),
      tip_tolerance_(options.tip_tolerance_mm),
      axis_tolerance_(options.axis_tolerance_rad),
      period_(static_cast<double>(model.cycle_ns) * 1e-9),
      overrides_(options.overrides, ramp_cycles(model)),
      follower_(path, tip_tolerance_, axis_tolerance_),
      tool_length_(path.begin_tool_length_mm()),
      nearest_(path.elements().size() + 1, std::numeric_limits<double>::infinity()),
      in_gap_(path.elements().size() + 1, false) {}

double PathJudge::vertex_s(std::size_t index) const noexcept {
  if (index == 0) return 0;
  const PathElement& element = path_.elements()[index - 1];
  return element.s + element.length;
}

ToolPose PathJudge::vertex(std::size_t index) const noexcept {
  return index == 0 ? path_.begin() : path_.elements()[index - 1].pose(1);
}

std::uint32_t PathJudge::vertex_line(std::size_t index) const noexcept {
  return index == 0 ? path_.begin_line() : path_.elements()[index - 1].line;
}

/// The match of the joints, with the tool that is in the spindle there. At the end of an element
/// behind which another tool goes on, the new tool is taken as soon as it fits as well.
PoseMatch PathJudge::match(const JointVector& joints, ToolPose& pose) {
  pose = forward(model_, tool_length_, joints);
  const bool is_beside_pole = pole_distance(model_, pose.axis) < kPoleReach_rad;
  allowed_axis_ = is_beside_pole ? options_.pole_tolerance_rad : axis_tolerance_;
  follower_.set_axis_tolerance(allowed_axis_);
  const PoseMatch with_old = follower_.follow(pose);
  const auto& elements = path_.elements();
  const std::size_t next = with_old.element + 1;
  if (next >= elements.size() || elements[next].tool_length_mm == tool_length_) return with_old;
  const double left = elements[next].s - with_old.s;
  if (left > kVertexMargin_mm) return with_old;
  const ToolPose other = forward(model_, elements[next].tool_length_mm, joints);
  const PoseMatch with_new = follower_.match_begin(other, next);
  if (follower_.badness(with_new) > follower_.badness(with_old)) return with_old;
  tool_length_ = elements[next].tool_length_mm;
  follower_.jump(other, with_new);
  tip_count_ = 0;
  pose = other;
  return with_new;
}

void PathJudge::sample(const JointVector& joints, const Place& place, bool is_setpoint) {
  ToolPose pose;
  here_ = match(joints, pose);
  (is_setpoint ? tip_ : tip_between_).raise(here_.tip_mm, place.cycle, place.line);
  (is_setpoint ? axis_ : axis_between_).raise(here_.axis_rad, place.cycle, place.line);
  if (here_.tip_mm > tip_tolerance_ * (1 + kRoundingShare)) {
    tip_over_.worst.raise(here_.tip_mm, place.cycle, place.line);
    tip_over_.count += is_setpoint ? 1 : 0;
  }
  if (here_.axis_rad > allowed_axis_ * (1 + kRoundingShare)) {
    if (here_.axis_rad > axis_over_.worst.value) exceeded_axis_ = allowed_axis_;
    axis_over_.worst.raise(here_.axis_rad, place.cycle, place.line);
    axis_over_.count += is_setpoint ? 1 : 0;
  }
  pass_vertices(pose, here_.s);
}

/// Vertices near the chord from the last sample to this one.
void PathJudge::pass_vertices(const ToolPose& pose, double s) {
  tips_ = {tips_[1], tips_[2], pose.tip};
  tip_count_ = std::min(tip_count_ + 1, 3);
  const Vector3& from = tip_count_ > 1 ? tips_[1] : tips_[2];
  const double chord = (pose.tip - from).norm();
  const double sag =
      tip_count_ < 3 ? 0.0
                     : std::min(kLargestSag_mm, (tips_[0] - 2 * tips_[1] + tips_[2]).norm() / 8);
  const double margin = kVertexMargin_mm + 3 * chord;
  reached_ = std::max(reached_, s);
  while (low_ + 1 < nearest_.size() && vertex_s(low_) < reached_ - margin) ++low_;
  for (std::size_t i = low_; i < nearest_.size() && vertex_s(i) <= s + margin; ++i) {
    const double distance = distance_to_chord(vertex(i).tip, from, pose.tip);
    nearest_[i] = std::min(nearest_[i], std::max(0.0, distance - sag));
  }
}

void PathJudge::add_gap(double s_from, double s_to) {
  const double low = std::min(s_from, s_to) - kVertexMargin_mm;
  const double high = std::max(s_from, s_to) + kVertexMargin_mm;
  for (std::size_t i = low_; i < in_gap_.size() && vertex_s(i) <= high; ++i) {
    if (vertex_s(i) >= low) in_gap_[i] = true;
  }
}

/// Tip and axis between two consecutive setpoints against the fastest feed programmed on the way.
void PathJudge::judge_speed(const Place& from, const Place& to, double s_from, double s_to) {
  const ToolPose a = forward(model_, tool_length_, from.joints);
  const ToolPose b = forward(model_, tool_length_, to.joints);
  const double speed = (b.tip - a.tip).norm() / period_;
  speed_.raise(speed, to.cycle, to.line);
  const auto& elements = path_.elements();
  if (elements.empty() || speed == 0) return;
  const double margin = tip_tolerance_ + kAxisLength_mm_per_rad * axis_tolerance_;
  const double low = std::min(s_from, s_to) - margin, high = std::max(s_from, s_to) + margin;
  auto element = std::upper_bound(elements.begin(), elements.end(), low,
                                  [](double s, const PathElement& e) { return s < e.s; });
  if (element != elements.begin()) --element;
  double feed = 0, turn = 0;
  for (; element != elements.end() && element->s <= high; ++element) {
    feed = std::max(feed, element->feed_mm_per_s);
    turn = std::max(turn, element->turn_rad_per_s);
  }
  const double factor = options_.overrides.empty() ? options_.feed_factor : overrides_.at(to.cycle);
  double allowed = feed * factor;
  if (factor > 1 && model_.max_feed_mm_per_s > 0) {
    allowed = std::min(allowed, model_.max_feed_mm_per_s);
  }
  // At an override of 0 the tip stands but for the last bit of its place.
  const double use = std::max(0.0, speed - kPlace_mm / period_) / std::max(allowed, kLeastFeed);
  feed_.raise(use, to.cycle, to.line);
  if (use > 1 + kRoundingShare) {
    feed_over_.worst.raise(use, to.cycle, to.line);
    ++feed_over_.count;
  }
  const double rate = angle_between(a.axis, b.axis) / period_;
  if (turn > 0 && rate > turn * factor * (1 + kRoundingShare) + 1e-9) {
    turn_over_.worst.raise(rate / turn, to.cycle, to.line);
    ++turn_over_.count;
  }
}

/// Goes from the last but one place to the last: between them first, where four places say how.
void PathJudge::step(bool has_between) {
  const Place& from = places_[1];
  const Place& to = places_[2];
  const double s_from = here_.s;
  const bool is_rest = from.joints == to.joints && places_[0].joints == from.joints &&
                       places_[3].joints == to.joints;
  if (is_rest && to.cycle == from.cycle + 1) return;
  if (has_between && !is_rest) {
    for (const double x : {0.25, 0.5, 0.75}) {
      JointVector q{};
      for (int i = 0; i < model_.joint_count; ++i) {
        q[i] = -x * (x - 1) * (x - 2) / 6 * places_[0].joints[i] +
               (x + 1) * (x - 1) * (x - 2) / 2 * from.joints[i] -
               (x + 1) * x * (x - 2) / 2 * to.joints[i] +
               (x + 1) * x * (x - 1) / 6 * places_[3].joints[i];
      }
      sample(q, from, false);
    }
  }
  const bool is_gap = to.cycle != from.cycle + 1;
  if (is_gap) tip_count_ = 0;
  sample(to.joints, to, true);
  if (is_gap) {
    add_gap(s_from, here_.s);
  } else {
    judge_speed(from, to, s_from, here_.s);
  }
}

void PathJudge::add(const RecordingRow& row) {
  std::rotate(places_.begin(), places_.begin() + 1, places_.end());
  places_[3] = {row.cycle, row.line, row.joints};
  const bool is_next = known_ > 0 && row.cycle == places_[2].cycle + 1;
  run_ = is_next ? std::min(run_ + 1, 4) : 1;
  known_ = std::min(known_ + 1, 4);
  if (known_ == 1) {
    sample(row.joints, places_[3], true);
  } else if (known_ == 3) {
    places_[0] = places_[1];
    step(false);
  } else if (known_ == 4) {
    step(run_ == 4);
  }
}

void PathJudge::finish(CheckReport& report) {
  if (known_ > 1) {  // the last place has none behind it
    std::rotate(places_.begin(), places_.begin() + 1, places_.end());
    places_[3] = places_[2];
    if (known_ == 2) places_[0] = places_[1];
    step(false);
  }
  report.tip_mm = tip_;
  report.axis_rad = axis_;
  report.tip_between_mm = tip_between_;
  report.axis_between_rad = axis_between_;
  report.feed = feed_;
  report.tip_speed_mm_per_s = speed_;
  char text[256];
  const auto find = [&](Finding::Kind kind, const Excess& excess) {
    report.findings.push_back({kind, text, excess.worst.cycle, excess.worst.line, excess.count});
  };
  if (tip_over_.worst.value > 0) {
    std::snprintf(text, sizeof text, "tip is %.6f mm off the path, tolerance %.6g mm",
                  tip_over_.worst.value, tip_tolerance_);
    find(Finding::Kind::kTip, tip_over_);
  }
  if (axis_over_.worst.value > 0) {
    std::snprintf(text, sizeof text, "tool axis is %.6f deg off the path, tolerance %.6g deg",
                  units::deg_from_rad(axis_over_.worst.value), units::deg_from_rad(exceeded_axis_));
    find(Finding::Kind::kAxis, axis_over_);
  }
  if (feed_over_.count > 0) {
    std::snprintf(text, sizeof text, "tip speed is %.6f x the programmed feed%s in %llu cycles",
                  feed_over_.worst.value, options_.overrides.empty() ? "" : " times the override",
                  static_cast<unsigned long long>(feed_over_.count));
    find(Finding::Kind::kFeed, feed_over_);
  }
  if (turn_over_.count > 0) {
    std::snprintf(text, sizeof text, "tool axis turns %.6f x as fast as its inverse time allows",
                  turn_over_.worst.value);
    find(Finding::Kind::kTurnRate, turn_over_);
  }
  finish_vertices(report);
}

void PathJudge::finish_vertices(CheckReport& report) const {
  Excess missed;
  bool is_unfinished = false;
  for (std::size_t i = 0; i < nearest_.size(); ++i) {
    const bool is_ahead = vertex_s(i) > reached_ + tip_tolerance_ &&
                          nearest_[i] > tip_tolerance_ * (1 + kRoundingShare);
    if (is_ahead && vertex_s(i) > reached_ + kVertexMargin_mm) {
      is_unfinished = true;
      if (options_.allow_unfinished) break;
    }
    if (is_ahead && options_.allow_unfinished) break;
    ++report.vertices;
    const bool is_missed = nearest_[i] > tip_tolerance_ * (1 + kRoundingShare);
    if (is_missed && in_gap_[i]) {
      ++report.vertices_in_gaps;
      continue;
    }
    const double distance = std::isfinite(nearest_[i]) ? nearest_[i] : vertex_s(i) - reached_;
    report.vertex_mm.raise(distance, 0, vertex_line(i));
    if (!is_missed) continue;
    missed.worst.raise(distance, 0, vertex_line(i));
    ++missed.count;
  }
  char text[256];
  if (missed.count > 0) {
    std::snprintf(text, sizeof text, "%llu CL vertices were missed, the worst by %.6f mm",
                  static_cast<unsigned long long>(missed.count), missed.worst.value);
    report.findings.push_back({Finding::Kind::kVertex, text, 0, missed.worst.line, missed.count});
  }
  if (is_unfinished && !options_.allow_unfinished) {
    std::snprintf(text, sizeof text, "the path was cut to %.3f of %.3f mm of its common length",
                  reached_, path_.length());
    report.findings.push_back(
        {Finding::Kind::kUnfinished, text, places_.back().cycle, places_.back().line, 1});
  }
}

}  // namespace meridian::record
