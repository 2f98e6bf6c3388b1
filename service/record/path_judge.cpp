// SPDX-License-Identifier: Apache-2.0
#include "service/record/path_judge.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"

namespace meridian::record {
namespace {

/// A vertex is looked for this far before and behind the place where the tool is, and twice the
/// tolerances: the tool and the place that it is held against are both within one of it.
constexpr double kVertexMargin_mm = 0.1;
/// A chord between samples cuts no more than this off a smooth way.
constexpr double kLargestSag_mm = 1e-4;
/// A block shorter than that turns the axis alone.
constexpr double kNoTip_mm = 1e-9;

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
      follower_(path, tip_tolerance_, axis_tolerance_),
      speeds_(model, path, reach_of_match(), options),
      times_(path, reach_of_match(), static_cast<double>(model.cycle_ns) * 1e-9, options),
      tool_length_(path.begin_tool_length_mm()),
      nearest_(path.elements().size() + 1, std::numeric_limits<double>::infinity()),
      turned_(nearest_),
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

/// Whether the tip stands on one side of the vertex, while the axis turns.
bool PathJudge::is_turn(std::size_t index) const noexcept {
  const auto turns = [](const PathElement& element) {
    return element.axis_turn > 0 && element.tip_length() < kNoTip_mm;
  };
  const auto& elements = path_.elements();
  return (index > 0 && turns(elements[index - 1])) ||
         (index < elements.size() && turns(elements[index]));
}

/// How far along the way a place of the path may lie from where its pose is matched, mm.
double PathJudge::reach_of_match() const noexcept {
  return tip_tolerance_ +
         kAxisLength_mm_per_rad * std::max(axis_tolerance_, options_.pole_tolerance_rad);
}

double PathJudge::axis_tolerance_at(const Vector3& axis) const noexcept {
  return pole_distance(model_, axis) < kPoleReach_rad ? options_.pole_tolerance_rad
                                                      : axis_tolerance_;
}

/// The match of the joints, with the tool that is in the spindle there. At the end of an element
/// behind which another tool goes on, the new tool is taken as soon as it fits as well.
PoseMatch PathJudge::match(const JointVector& joints, ToolPose& pose) {
  pose = forward(model_, tool_length_, joints);
  allowed_axis_ = axis_tolerance_at(pose.axis);
  follower_.set_axis_tolerance(allowed_axis_);
  const PoseMatch with_old = follower_.follow(pose);
  const auto& elements = path_.elements();
  if (elements.empty()) return with_old;
  // Of a path that begins with a tool change no element is cut with the tool before.
  const bool is_at_begin = elements.front().tool_length_mm != tool_length_ && reached_ == 0;
  const std::size_t next = is_at_begin ? 0 : with_old.element + 1;
  if (next >= elements.size() || elements[next].tool_length_mm == tool_length_) return with_old;
  const double left = elements[next].s - with_old.s;
  if (left > kVertexMargin_mm) return with_old;
  if (is_at_begin) nearest_[0] = std::min(nearest_[0], (pose.tip - vertex(0).tip).norm());
  const ToolPose other = forward(model_, elements[next].tool_length_mm, joints);
  const PoseMatch with_new = follower_.match_begin(other, next);
  if (follower_.badness(with_new) > follower_.badness(with_old)) return with_old;
  tool_length_ = elements[next].tool_length_mm;
  follower_.jump(other, with_new);
  pose_count_ = 0;
  pose = other;
  return with_new;
}

void PathJudge::sample(const JointVector& joints, const Place& place, bool is_setpoint) {
  ToolPose pose;
  last_element_ = here_.element;
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
  pass_vertices(pose);
}

/// How far the pose stays away from a vertex on the chord from the last sample to this one, in
/// tolerances of tip and axis together.
double PathJudge::miss_of_turn(const ToolPose& vertex) const {
  const ToolPose& from = poses_[pose_count_ > 1 ? 1 : 2];
  const Vector3 tip = poses_[2].tip - from.tip, axis = poses_[2].axis - from.axis;
  const double axis_tolerance = axis_tolerance_at(vertex.axis);
  const auto miss = [&](double t) {
    return std::max((from.tip + t * tip - vertex.tip).norm() / tip_tolerance_,
                    (from.axis + t * axis - vertex.axis).norm() / axis_tolerance);
  };
  double low = 0, high = 1;
  for (int n = 0; n < 30; ++n) {
    const double left = low + (high - low) / 3, right = high - (high - low) / 3;
    (miss(left) < miss(right) ? high : low) = miss(left) < miss(right) ? right : left;
  }
  return miss(0.5 * (low + high));
}

/// Holds a vertex against the chord from the last sample to this one. False where the tool is far
/// from it.
bool PathJudge::pass_vertex(std::size_t index) {
  const ToolPose pose = vertex(index);
  const ToolPose& from = poses_[pose_count_ > 1 ? 1 : 2];
  const double chord = (poses_[2].tip - from.tip).norm();
  const double turn = kAxisLength_mm_per_rad * (poses_[2].axis - from.axis).norm();
  const double axis_tolerance = kAxisLength_mm_per_rad * axis_tolerance_at(pose.axis);
  const double distance = distance_to_chord(pose.tip, from.tip, poses_[2].tip);
  const double angle = kAxisLength_mm_per_rad * (poses_[2].axis - pose.axis).norm();
  const double sag = pose_count_ < 3
                         ? 0.0
                         : std::min(kLargestSag_mm,
                                    (poses_[0].tip - 2 * poses_[1].tip + poses_[2].tip).norm() / 8);
  nearest_[index] = std::min(nearest_[index], std::max(0.0, distance - sag));
  if (distance > kVertexMargin_mm + 2 * tip_tolerance_ + 3 * chord) return false;
  if (is_turn(index)) turned_[index] = std::min(turned_[index], miss_of_turn(pose));
  return angle <= kVertexMargin_mm + 2 * axis_tolerance + 3 * turn;
}

/// The vertices between the last sample and this one, and on from either as far as the path stays
/// near the tool, but none that the tool has left behind.
void PathJudge::pass_vertices(const ToolPose& pose) {
  poses_ = {poses_[1], poses_[2], pose};
  pose_count_ = std::min(pose_count_ + 1, 3);
  reached_ = std::max(reached_, here_.s);
  const std::size_t last = nearest_.size() - 1;
  const std::size_t least = follower_.earliest().element;
  const std::size_t low = std::max(least, std::min(last_element_, here_.element));
  const std::size_t high = std::min(last, std::max(last_element_, here_.element) + 1);
  for (std::size_t i = low + 1; i < high; ++i) static_cast<void>(pass_vertex(i));
  for (std::size_t i = low; pass_vertex(i) && i > least; --i) {
  }
  for (std::size_t i = high; pass_vertex(i) && i < last; ++i) {
  }
}

void PathJudge::add_gap(double s_from, double s_to) {
  const double margin =
      kVertexMargin_mm + 2 * (tip_tolerance_ + kAxisLength_mm_per_rad * axis_tolerance_);
  const double low = std::min(s_from, s_to) - margin, high = std::max(s_from, s_to) + margin;
  std::size_t first = here_.element;
  while (first > 0 && vertex_s(first) >= low) --first;
  for (std::size_t i = first; i < in_gap_.size() && vertex_s(i) <= high; ++i) {
    if (vertex_s(i) >= low) in_gap_[i] = true;
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
  if (is_gap) pose_count_ = 0;
  sample(to.joints, to, true);
  if (!path_.elements().empty()) {
    const double passed = path_.way_at(follower_.length_at(follower_.earliest()));
    times_.add(path_.way_at(reached_), passed, to.cycle);
  }
  if (is_gap) {
    add_gap(s_from, here_.s);
  } else if (is_under_way_) {
    const auto tool_at = [this](const Place& place) {
      return forward(model_, tool_length_, place.joints);
    };
    speeds_.add(tool_at(from), tool_at(to), s_from, here_.s, to.cycle, to.line);
  }
  is_under_way_ = true;
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
  speeds_.finish(report);
  times_.finish(report);
  finish_vertices(report);
}

void PathJudge::finish_vertices(CheckReport& report) const {
  Excess missed, unturned;
  bool is_unfinished = false;
  const double surely_reached = follower_.length_at(follower_.earliest());
  for (std::size_t i = 0; i < nearest_.size(); ++i) {
    const bool is_missed = nearest_[i] > tip_tolerance_ * (1 + kRoundingShare);
    const bool is_unturned = is_turn(i) && turned_[i] > 1 + kRoundingShare;
    const bool is_ahead = vertex_s(i) > surely_reached && (is_missed || is_unturned);
    if (is_ahead && options_.allow_unfinished) break;
    if (is_missed && vertex_s(i) > reached_ + kVertexMargin_mm) is_unfinished = true;
    ++report.vertices;
    if ((is_missed || is_unturned) && in_gap_[i]) {
      ++report.vertices_in_gaps;
      continue;
    }
    const double distance = std::isfinite(nearest_[i]) ? nearest_[i] : vertex_s(i) - reached_;
    report.vertex_mm.raise(distance, 0, vertex_line(i));
    if (is_missed) {
      missed.add(distance, 0, vertex_line(i));
    } else if (is_unturned) {
      unturned.add(turned_[i], 0, vertex_line(i));
    }
  }
  char text[256];
  if (missed.count > 0) {
    std::snprintf(text, sizeof text, "%llu CL vertices were missed, the worst by %.6f mm",
                  static_cast<unsigned long long>(missed.count), missed.worst.value);
    report.findings.push_back({Finding::Kind::kVertex, text, 0, missed.worst.line, missed.count});
  }
  if (unturned.count > 0) {
    std::snprintf(text, sizeof text,
                  "%llu CL vertices at turns of the axis alone were missed, the worst by %.3f "
                  "tolerances of tip and axis together",
                  static_cast<unsigned long long>(unturned.count), unturned.worst.value);
    report.findings.push_back(
        {Finding::Kind::kVertex, text, 0, unturned.worst.line, unturned.count});
  }
  if (is_unfinished && !options_.allow_unfinished) {
    std::snprintf(text, sizeof text, "the path was cut to %.3f of %.3f mm of its common length",
                  reached_, path_.length());
    report.findings.push_back(
        {Finding::Kind::kUnfinished, text, places_.back().cycle, places_.back().line, 1});
  }
}

}  // namespace meridian::record
