// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_string.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/feed/solver/parabola.hpp"
#include "service/core/planner/singular/pole/pole_time.hpp"

namespace meridian {
namespace {

constexpr double kNoTime = std::numeric_limits<double>::infinity();
constexpr double kMinGain_s = 1e-3;  // of the string over the exact path
constexpr double kSameWinding_rad = 0.5;
constexpr int kMaxCourses = 2;  // that are tried, of those that lead on
constexpr int kWallRounds = 8;  // of nearer walls where a result leaves the tolerance between nodes
constexpr FreeSpline::Shape kShapes[] = {{5, 0, 1, 100}, {2, 0, 1, 100},   {5, 0, 0, 0},
                                         {2, 0, 0, 100}, {5, 0.5, 0, 100}, {1, 0.5, 0, 30}};

/// Largest value that a smooth function may have about the middle of three samples: there, or at
/// the top of the parabola through them.
double top_of(double left, double middle, double right) noexcept {
  const Parabola about(left, middle, right);
  return about.bend > 0 && middle >= left && middle >= right ? about.top() : middle;
}

}  // namespace

PoleString::PoleString()
    : best_(FreeSpline::kPieces), trial_(FreeSpline::kPieces), values_(PoleWalls::kNodes) {}

std::span<const PoleZone> PoleString::find(const PoleTask& task, const PolePass& pass) noexcept {
  task_ = &task;
  pass_ = &pass;
  free_ = redundant_joint(task.model);
  best_count_ = 0;
  best_time_ = kNoTime;
  walls_.loosen();
  for (round_ = 0; round_ < kWallRounds; ++round_) {
    is_any_off_ = false;
    if (!walls_.look(task, pass)) return {};
    find_best();
    if (best_time_ < kNoTime) return {best_.data(), best_count_};
    if (!is_any_off_) return {};
  }
  return {};
}

bool PoleString::is_exact_best() const noexcept { return best_count_ == 0 && best_time_ < kNoTime; }

/// Of what leads on to routes that carry farthest, as far as there is such.
void PoleString::find_best() noexcept {
  int below = std::numeric_limits<int>::max();
  for (std::size_t level = 0; level + 1 < kMaxLevels && best_time_ == kNoTime; ++level) {
    int blocks = 0;
    for (const RouteAhead& route : pass_->ahead) {
      if (route.carries < below) blocks = std::max(blocks, route.carries);
    }
    if (blocks == 0) break;
    below = blocks;
    (void)find_best({true, blocks});
  }
  if (best_time_ < kNoTime) return;
  if (!find_best({true, 0})) (void)find_best({});  // a rewind may help
}

/// Leaves no pieces where the exact path is the best. False: no route leads on.
bool PoleString::find_best(const Ahead& ahead) noexcept {
  const bool is_exact_kept = has_exact(ahead);
  if (is_exact_kept) best_time_ = exact_time() - kMinGain_s;
  int tried = 0;
  for (const auto& course : walls_.find_courses(pass_->joints[free_])) {
    if (!leads_on(course, ahead)) continue;
    try_course(course);
    if (++tried == kMaxCourses) break;
  }
  return is_exact_kept || tried > 0;
}

bool PoleString::carries(int branch, const RouteAfter& route, int blocks) const noexcept {
  if (blocks == 0 || !route.is_to_end) return true;
  for (const RouteAhead& ahead : pass_->ahead) {
    if (ahead.branch == branch && std::abs(ahead.free - route.free) < kSameWinding_rad) {
      return ahead.carries >= blocks;
    }
  }
  return false;
}

bool PoleString::leads_on(const PoleWalls::Course& course, const Ahead& ahead) const noexcept {
  if (!ahead.keeps_travel || pass_->at_end != PoleJoin::kExact) return true;
  JointVector joints = pass_->joints;
  joints[free_] = PoleWalls::middle_of(walls_.nodes().back(), course.side);
  const int branch = course.side & 1;
  const RouteAfter route = follow_after(*task_, *pass_, pass_->end, joints, branch);
  return route.keeps_travel && carries(branch, route, ahead.blocks);
}

bool PoleString::has_exact(const Ahead& ahead) const noexcept {
  if (pass_->exact != ExactPath::kLeadsOn) return false;
  if (pass_->at_begin == PoleJoin::kHeld || pass_->at_end == PoleJoin::kHeld) return false;
  if (!ahead.keeps_travel) return true;
  const RouteAfter route = follow_after(*task_, *pass_, pass_->begin, pass_->joints, pass_->branch);
  return route.keeps_travel && carries(pass_->branch, route, ahead.blocks);
}

FreeEnd PoleString::exact_end(double u, int branch, double near) const noexcept {
  JointVector reference = pass_->joints;
  reference[free_] = near;
  const auto at =
      solve(task_->model, task_->tool_length_mm, pose_of<Jet<2>>(*task_, u), branch, reference);
  const Jet<2>& c = at.q[free_];
  return {{value_of(c), c.derivative(1), c.derivative(2)}, 3};
}

FreeEnd PoleString::begin_of() const noexcept {
  const double value = pass_->joints[free_];
  switch (pass_->at_begin) {
    case PoleJoin::kExact:
      return exact_end(pass_->begin, pass_->branch, value);
    case PoleJoin::kHeld:
      return {{value, pass_->rate, 0}, 3};
    case PoleJoin::kRest:
      break;
  }
  return {{value, 0, 0}, 1};
}

/// As many nodes as lie on the stretch.
std::size_t PoleString::node_count() const noexcept {
  const auto nodes = walls_.nodes();
  const auto later = std::find_if(nodes.begin(), nodes.end(),
                                  [this](const auto& node) { return node.u > pass_->end; });
  return static_cast<std::size_t>(later - nodes.begin());
}

FreeEnd PoleString::end_of(const PoleWalls::Course& course,
                           std::span<const StringWindow> windows) noexcept {
  const auto nodes = walls_.nodes();
  switch (pass_->at_end) {
    case PoleJoin::kExact:
      return exact_end(pass_->end, course.side & 1,
                       PoleWalls::middle_of(nodes.back(), course.side));
    case PoleJoin::kHeld: {  // where the string through all that is known is
      pull_taut(windows, pass_->joints[free_], {values_.data(), windows.size()});
      const std::size_t at = node_count() - 1, next = std::min(at + 1, nodes.size() - 1);
      const double du = nodes[next].u - nodes[at].u;
      const double rate = du > 0 ? (values_[next] - values_[at]) / du : 0;
      return {{values_[at], rate, 0}, 3};
    }
    case PoleJoin::kRest:
      break;
  }
  return {};
}

void PoleString::try_course(const PoleWalls::Course& course) noexcept {
  const auto windows = walls_.windows_of(course);
  const FreeEnd begin = begin_of(), end = end_of(course, windows);
  const std::size_t count = node_count();
  for (const FreeSpline::Shape& shape : kShapes) {
    if (!spline_.fit(task_->spans, walls_.nodes().first(count), windows.first(count), begin, end,
                     shape)) {
      continue;
    }
    take_pieces(course);
    const double time = time_of_trial(best_time_);
    if (!(time < best_time_) || !is_inside() || !is_inside_at_kinks()) continue;
    for (std::size_t n = 0; n < trial_count_; ++n) trial_[n].deviation_rad = deviation_rad_;
    best_time_ = time;
    best_count_ = trial_count_;
    std::swap(best_, trial_);
  }
}

void PoleString::take_pieces(const PoleWalls::Course& course) noexcept {
  const bool is_exact = pass_->at_end == PoleJoin::kExact;
  const int after = is_exact ? course.side & 1 : pass_->branch;
  trial_count_ = spline_.size();
  for (std::size_t n = 0; n < trial_count_; ++n) {
    PoleZone& piece = trial_[n];
    piece = spline_.piece(n);
    piece.branch_before = piece.branch_after = pass_->branch;
    piece.is_through = after != pass_->branch;
  }
  trial_[0].is_first = true;
  PoleZone& last = trial_[trial_count_ - 1];
  last.branch_after = after;
  last.is_last = true;
  last.is_held = pass_->at_end == PoleJoin::kHeld;
}

/// Angle to the programmed axis; infinite where a joint leaves travel.
double PoleString::off_at(double u, double free) const noexcept {
  const MachineModel& model = task_->model;
  const ToolPose pose = pose_of<double>(*task_, u);
  const auto at = solve_held(model, task_->tool_length_mm, pose, free);
  if (at.status == SolveStatus::kUnreachable) return kNoTime;
  if (first_joint_outside_travel(model, at.q, kTravelMargin) >= 0) return kNoTime;
  const Vector3 axis = forward(model, task_->tool_length_mm, at.q).axis;
  return task_->is_exact ? angle_between(pose.axis, axis) : task_->programmed.angle_to(u, axis);
}

/// Remembers the largest angle. False where it leaves the tolerance: there walls have to be nearer
/// about the piece.
bool PoleString::is_within(const PoleZone& piece, double off) noexcept {
  deviation_rad_ = std::max(deviation_rad_, off);
  if (off <= kSampledShare * task_->tolerance_rad) return true;
  const bool is_known = off < kNoTime && walls_.tighten(piece.begin, piece.end, round_);
  is_any_off_ = is_any_off_ || is_known;
  return false;
}

bool PoleString::is_inside() noexcept {
  constexpr int kSteps = 8;
  deviation_rad_ = 0;
  bool is_inside = true;
  for (std::size_t n = 0; n < trial_count_; ++n) {
    const PoleZone& piece = trial_[n];
    std::array<double, kSteps + 1> off{};
    for (std::size_t k = 0; k <= kSteps; ++k) {
      const double t = static_cast<double>(k) / kSteps;
      off[k] = off_at(piece.begin + t * (piece.end - piece.begin), quintic_at(piece.free, t));
      if (off[k] == kNoTime) return false;
      const double top = k < 2 ? off[k] : std::max(off[k], top_of(off[k - 2], off[k - 1], off[k]));
      is_inside = is_within(piece, top) && is_inside;
    }
  }
  return is_inside;
}

/// Where the programmed axis turns sharply even places are too far apart.
bool PoleString::is_inside_at_kinks() noexcept {
  if (task_->is_exact) return true;  // the smoothed axis counts, which has none
  std::array<double, 256> kinks;
  const std::size_t count = task_->programmed.find_kinks(pass_->begin, pass_->end, kinks);
  bool is_inside = true;
  std::size_t n = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = kinks[i];
    while (n + 1 < trial_count_ && trial_[n].end < u) ++n;
    const PoleZone& piece = trial_[n];
    const double t = (u - piece.begin) / (piece.end - piece.begin);
    if (!(t > 0 && t < 1)) continue;
    is_inside = is_within(piece, off_at(u, quintic_at(piece.free, t))) && is_inside;
  }
  return is_inside;
}

double PoleString::time_of_trial(double largest) const noexcept {
  constexpr int kSteps = 2;
  double sum = 0;
  for (std::size_t n = 0; n < trial_count_ && sum <= largest; ++n) {
    const PoleZone& piece = trial_[n];
    const double h = piece.end - piece.begin;
    for (int k = 0; k < kSteps; ++k) {
      const double t = (k + 0.5) / kSteps, u = piece.begin + t * h;
      const BandSpan& span = task_->spans.span_at(u);
      const auto pose = pose_of<Jet<3>>(span, u);
      const auto held =
          solve_held(task_->model, task_->tool_length_mm, pose, free_at(piece.free, t, h));
      sum += h / kSteps * slowness(task_->model, span, pose, held.q);
    }
  }
  return sum;
}

double PoleString::exact_time() const noexcept {
  const auto nodes = walls_.nodes();
  double sum = 0;
  for (std::size_t n = 1; n < nodes.size(); ++n) {
    const double u = 0.5 * (nodes[n - 1].u + nodes[n].u);
    const BandSpan& span = task_->spans.span_at(u);
    const auto pose = pose_of<Jet<3>>(span, u);
    const auto at = solve(task_->model, task_->tool_length_mm, pose, pass_->branch, pass_->joints);
    const double time = (nodes[n].u - nodes[n - 1].u) * slowness(task_->model, span, pose, at.q);
    sum += std::isfinite(time) ? time : 0;
  }
  return sum;
}

}  // namespace meridian
