// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_walls.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/legs/leg_planner.hpp"
#include "service/core/planner/singular/pole/pole_time.hpp"

namespace meridian {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMaxMoved = 0.25;  // of the axis between nodes, of its distance and tolerance
constexpr double kMaxTurned_rad = 0.3;
constexpr double kMinStep_mm = 1e-6;
constexpr double kUsedShare = 0.995;  // of the tolerance: nodes are not everywhere
constexpr double kTightened = 0.97;   // of it where that was not enough, each time
constexpr double kNodesOfSpan = 6;
constexpr double kMinBlock_mm = 0.03;      // the end of a shorter block is no place of its own
constexpr double kMinTime_s = 1e-9;        // between nodes: times ascend
constexpr double kProbe_rad = 1e-2;        // of axes that show how the redundant joint turns
constexpr double kSmallAxis_rad = 4e-9;    // nearer, the exact redundant joint is not asked for
constexpr int kSides = 1, kLastSides = 3;  // beside the nearest that are tried
constexpr std::int32_t kMaxAlike = 8;      // routes past one wall that are kept

}  // namespace

/// A place of the path as it is seen along the pole.
struct PoleWalls::Seen {
  double u = 0;
  double t = 0;
  Vector3 tip = Vector3::Zero();
  double x = 0, y = 0;    ///< p
  double px = 0, py = 0;  ///< p'
  double allowed = 0;     ///< between p' and what results
  std::array<JointVector, 2> joints{};
  Node node;
};

PoleWalls::PoleWalls() : nodes_(kNodes), runs_(kRuns), courses_(kCourses), windows_(kNodes) {}

double PoleWalls::middle_of(const Node& node, int side) noexcept {
  const int branch = side & 1;
  return node.middle[static_cast<std::size_t>(branch)] + (side - branch) / 2 * kTurn_rad;
}

/// Sees the path at `u`; false where joints have turned too far since `before` for it to be known
/// which way.
bool PoleWalls::see(double u, const Seen& before, Seen& out) const noexcept {
  const PoleTask& task = *task_;
  const BandSpan& span = task.spans.span_at(u);
  const ToolPose pose = pose_of<double>(span, u);
  out.u = u;
  out.tip = pose.tip;
  const double du = u - before.u;
  const double distance = (pose.tip - before.tip).norm();
  out.t =
      before.t + std::max({distance / span.feed_mm_per_s, du / span.u_speed_mm_per_s, kMinTime_s});
  out.x = pose.axis.dot(across_);
  out.y = pose.axis.dot(along_);
  out.px = out.x;
  out.py = out.y;
  out.allowed = share_at(u) * task.tolerance_rad;
  if (const auto known = task.programmed.at(u); known && !task.is_exact) {
    out.px = known->axis.dot(across_);
    out.py = known->axis.dot(along_);
    out.allowed -= known->hidden_rad;
  }
  out.allowed = std::max(out.allowed, 0.0);

  const double rho = std::hypot(out.x, out.y), r = 0.5 * rho;
  const double vx = out.px - 0.5 * out.x, vy = out.py - 0.5 * out.y, d = std::hypot(vx, vy);
  out.node = {u, out.t, {}, kPi, false, false};
  out.joints = before.joints;
  if (rho > kSmallAxis_rad) {
    const double turn = std::remainder(std::atan2(vy, vx) - std::atan2(out.y, out.x), 2 * kPi);
    const double shift = d > 0 ? 0.5 * turn_sign_ * turn : 0;
    for (int branch = 0; branch < 2; ++branch) {
      const auto b = static_cast<std::size_t>(branch);
      const auto at = solve(task.model, task.tool_length_mm, pose, branch, before.joints[b]);
      if (at.status == SolveStatus::kUnreachable) return false;
      out.joints[b] = at.q;
      out.node.middle[b] = at.q[free_] + shift;
    }
  }
  if (d + r <= out.allowed) return true;
  out.node.is_wall = true;
  const double cosine = d * r > 0 ? (d * d + r * r - out.allowed * out.allowed) / (2 * d * r) : 1;
  out.node.half = 0.5 * std::acos(std::clamp(cosine, -1.0, 1.0));
  return true;
}

bool PoleWalls::tighten(double begin, double end, int round) noexcept {
  for (std::size_t n = 0; n < tight_count_; ++n) {
    Tight& tight = tight_[n];
    if (tight.begin > end || tight.end < begin) continue;
    if (tight.round != round) tight.share *= kTightened;
    tight = {std::min(tight.begin, begin), std::max(tight.end, end), tight.share, round};
    return true;
  }
  if (tight_count_ == tight_.size()) return false;
  tight_[tight_count_++] = {begin, end, kTightened, round};
  return true;
}

double PoleWalls::share_at(double u) const noexcept {
  double share = kUsedShare;
  for (std::size_t n = 0; n < tight_count_; ++n) {
    if (tight_[n].begin <= u && u <= tight_[n].end) share = std::min(share, tight_[n].share);
  }
  return share;
}

bool PoleWalls::look(const PoleTask& task, const PolePass& pass) noexcept {
  const double end = pass.at_end == PoleJoin::kHeld ? pass.seen_end : pass.end;
  task_ = &task;
  free_ = redundant_joint(task.model);
  const auto& joint = task.model.joints[free_];
  constexpr double kAny = std::numeric_limits<double>::infinity();
  low_ = joint.is_endless ? -kAny : joint.limits.travel_min;
  high_ = joint.is_endless ? kAny : joint.limits.travel_max;
  count_ = 0;

  const ToolPose begin = pose_of<double>(task, pass.begin);
  pole_ = find_nearest_pole(task.model, begin.axis);
  const Vector3 other = std::abs(pole_.x()) < 0.7 ? Vector3::UnitX() : Vector3::UnitY();
  across_ = (other - pole_ * pole_.dot(other)).normalized();
  along_ = pole_.cross(across_);
  const auto free_towards = [&](const Vector3& direction) {
    const ToolPose pose{begin.tip, (pole_ + kProbe_rad * direction).normalized()};
    return solve(task.model, task.tool_length_mm, pose, 0, pass.joints).q[free_];
  };
  const Vector3 turned = across_ + 0.1 * along_;
  const double by = free_towards(turned.normalized()) - free_towards(across_);
  turn_sign_ = std::remainder(by, 2 * kPi) < 0 ? -1 : 1;

  Seen last, next;
  last.u = pass.begin;
  last.tip = begin.tip;
  last.joints.fill(pass.joints);
  if (!see(pass.begin, last, next)) return false;
  next.node.is_pinned = pass.at_begin == PoleJoin::kExact;
  last = next;
  if (!add(last)) return false;
  double step = kAny, block_end = pass.begin;
  while (last.u < end) {
    const BandSpan& span = task.spans.span_at(last.u);
    const double whole = std::max(span.length / kNodesOfSpan, kMinStep_mm);
    step = std::min(2 * step, whole);
    if (last.u >= block_end) block_end = task.programmed.next_end(last.u + kMinBlock_mm);
    double stop = std::min(end, block_end);
    if (last.u < pass.end) stop = std::min(stop, pass.end);
    for (;; step *= 0.5) {
      const bool is_seen = see(std::min(last.u + step, stop), last, next);
      if (!is_seen && step <= kMinStep_mm) return false;
      if (is_seen && step <= kMinStep_mm) break;
      const double moved = std::max(std::hypot(next.x - last.x, next.y - last.y),
                                    std::hypot(next.px - last.px, next.py - last.py));
      const double far = std::hypot(last.px, last.py) + last.allowed;
      const bool is_near = moved <= kMaxMoved * far;
      const bool is_turn = next.node.is_wall && last.node.is_wall &&
                           std::abs(next.node.middle[0] - last.node.middle[0]) > kMaxTurned_rad;
      if (is_seen && is_near && !is_turn) break;
    }
    last = next;
    if (!add(last)) return false;
  }
  if (count_ > 0) nodes_[count_ - 1].is_pinned = pass.at_end == PoleJoin::kExact;
  return find_runs();
}

bool PoleWalls::add(const Seen& seen) noexcept {
  if (count_ == kNodes) return false;
  nodes_[count_++] = seen.node;
  return true;
}

/// Finds the walls; where one begins the branches come in the order of their values.
bool PoleWalls::find_runs() noexcept {
  run_count_ = 0;
  for (std::size_t n = 0; n < count_; ++n) {
    if (!nodes_[n].is_wall && !nodes_[n].is_pinned) continue;
    const bool goes_on = run_count_ > 0 && runs_[run_count_ - 1].last == n;
    if (!goes_on) {
      if (run_count_ == kRuns) return false;
      runs_[run_count_++] = {n, n};
    }
    runs_[run_count_ - 1].last = n + 1;
  }
  for (std::size_t i = 0; i < run_count_; ++i) {
    const Run& run = runs_[i];
    const Node& first = nodes_[run.first];
    const double apart = first.middle[1] - first.middle[0];
    const double turns = -std::floor(apart / kTurn_rad) * kTurn_rad;
    for (std::size_t n = run.first; n < run.last; ++n) nodes_[n].middle[1] += turns;
  }
  return true;
}

bool PoleWalls::walk(const Run& run, int side, Course& course) const noexcept {
  for (std::size_t n = run.first; n < run.last; ++n) {
    const Node& node = nodes_[n];
    const double middle = middle_of(node, side), half = node.is_pinned ? 0 : node.half;
    const double low = std::max(low_, middle - half), high = std::min(high_, middle + half);
    if (low > high) return false;
    const double value = std::clamp(course.value, low, high);
    course.turned += std::abs(value - course.value);
    course.value = value;
  }
  return true;
}

bool PoleWalls::pass(Run& run, std::span<const Course> from, std::int32_t base,
                     int spread) noexcept {
  run.begin = run.end = course_count_;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Node& first = nodes_[run.first];
    const int turn = static_cast<int>(std::floor((from[i].value - first.middle[0]) / kTurn_rad));
    int nearest = 2 * turn;
    for (int side = 2 * turn; side <= 2 * turn + 2; ++side) {
      const double off = std::abs(middle_of(first, side) - from[i].value);
      if (off < std::abs(middle_of(first, nearest) - from[i].value)) nearest = side;
    }
    for (int side = nearest - spread; side <= nearest + spread; ++side) {
      Course course = from[i];
      course.side = side;
      course.before = base + static_cast<std::int32_t>(i);
      if (!walk(run, side, course)) continue;
      const auto begin = courses_.begin();
      const auto same = std::find_if(begin + run.begin, begin + run.end,
                                     [side](const Course& c) { return c.side == side; });
      if (same != begin + run.end) {
        if (course.turned < same->turned) *same = course;
        continue;
      }
      if (run.end == static_cast<std::int32_t>(kCourses)) return false;
      courses_[static_cast<std::size_t>(run.end++)] = course;
    }
  }
  return run.end > run.begin;
}

/// Leaves out what another route reaches by a turn in the gate behind, and what is far from least.
void PoleWalls::prune(Run& run, bool is_last) noexcept {
  const auto begin = courses_.begin() + run.begin, end = courses_.begin() + run.end;
  std::sort(begin, end, [](const Course& a, const Course& b) {
    return a.turned != b.turned ? a.turned < b.turned : a.side < b.side;
  });
  std::int32_t kept = run.begin;
  for (auto course = begin; course != end && kept < run.begin + kMaxAlike; ++course) {
    const auto is_beaten = [&](const Course& other) {
      return other.turned + std::abs(other.value - course->value) <= course->turned;
    };
    if (!is_last && std::any_of(begin, courses_.begin() + kept, is_beaten)) continue;
    courses_[static_cast<std::size_t>(kept++)] = *course;
  }
  run.end = course_count_ = kept;
}

std::span<const PoleWalls::Course> PoleWalls::find_courses(double value) noexcept {
  course_count_ = 1;
  courses_[0] = {value, 0, 0, -1};
  std::int32_t begin = 0, end = 1;
  for (std::size_t i = 0; i < run_count_; ++i) {
    Run& run = runs_[i];
    const bool is_last = i + 1 == run_count_;
    const bool is_begun = run.first == 0;  // on the branch in force
    const std::span<const Course> from{courses_.data() + begin,
                                       static_cast<std::size_t>(end - begin)};
    const int spread = is_begun ? 0 : is_last ? kLastSides : kSides;
    if (!pass(run, from, begin, spread)) return {};
    prune(run, is_last);
    begin = run.begin;
    end = run.end;
  }
  return {courses_.data() + begin, static_cast<std::size_t>(end - begin)};
}

std::span<const StringWindow> PoleWalls::windows_of(const Course& course) noexcept {
  for (std::size_t n = 0; n < count_; ++n) windows_[n] = {nodes_[n].t, low_, high_};
  Course at = course;
  for (std::size_t i = run_count_; i-- > 0;) {
    const Run& run = runs_[i];
    for (std::size_t n = run.first; n < run.last; ++n) {
      if (!nodes_[n].is_wall) continue;
      const double middle = middle_of(nodes_[n], at.side);
      windows_[n].low = std::max(low_, middle - nodes_[n].half);
      windows_[n].high = std::min(high_, middle + nodes_[n].half);
    }
    at = courses_[static_cast<std::size_t>(at.before)];
  }
  return {windows_.data(), count_};
}

}  // namespace meridian
