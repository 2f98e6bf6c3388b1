// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/pole_corridor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/path/pose_at.hpp"
#include "meridian/planner/rest_to_rest.hpp"

namespace meridian {
namespace {

constexpr double kNear_rad = 0.05;        // minima farther off turn the free joint gently
constexpr double kZoneTolerances = 2.5;   // minima farther off leave a zone no room
constexpr double kDwellTolerances = 0.2;  // nearer, the path counts as on the pole
constexpr double kStayTolerances = 0.4;   // so far a path that comes back may go meanwhile
constexpr double kOtherTolerances = 3;    // another minimum nearer than that bounds the reach
/// A core that is longer than this is not waited for: the free joint comes to rest in it.
constexpr double kLongCore_mm = 2 * PoleCorridor::kReach_mm;
constexpr double kLeastHold_mm = 0.5;
constexpr double kReachShare = 0.98, kHalf = 0.49;
constexpr double kLeastReach_mm = 1e-3;
constexpr double kCutGrowth = 1.5, kFarthestCut_mm = 5, kFirstCut = 0.25;
constexpr double kLeastPart_mm = 1e-6;
constexpr double kTravelMargin = 1e-9;
/// Of the free joint between two places at which its winding is followed.
constexpr double kMostTurn_rad = 0.5, kLeastStep_mm = 1e-8;
/// Spans farther off than this (11.5 deg) are not held back. u advances by at least 50 mm per rad
/// of axis, so a zone beside them still has half of its reach.
constexpr double kOutOfReach_rad = 0.5 * PoleCorridor::kReach_mm / kAxisLength_mm_per_rad;

/// `span` from x = `from` on, `length` long.
BandSpan part_of_span(const BandSpan& span, double from, double length) noexcept {
  BandSpan out = span;
  out.u0 = span.u0 + from;
  out.length = length;
  for (auto& c : out.c) {  // Taylor shift
    for (int round = 0; round < 4; ++round) {
      for (int k = 3; k >= round; --k) c[k] += from * c[k + 1];
    }
  }
  return out;
}

}  // namespace

PoleCorridor::PoleCorridor(const MachineModel& model)
    : model_(model), held_(kHeld), pending_(kPending) {}

void PoleCorridor::begin(const Start& start) noexcept {
  has_pole_ = free_joint(model_) >= 0 && !start.is_on_pole;
  tool_length_mm_ = start.tool_length_mm;
  is_exact_ = model_.pole_policy == PolePolicy::kExact;
  tolerance_rad_ = is_exact_ ? kPoleEase_rad : std::max(start.tolerance_rad, kPoleEase_rad);
  programmed_.begin(start.axis);
  held_.clear();
  scan_ = 0;
  core_ = {};
  emitted_x_ = known_u_ = 0;
  known_ = start.joints;
  branch_ = out_branch_ = start.branch;
  pending_.clear();
  cut_count_ = 0;
  is_finished_ = is_held_ = is_out_held_ = has_failed_ = false;
  entered_ = -1;
  zones_ = 0;
}

void PoleCorridor::push(const BandSpan& span) noexcept {
  Held held;
  held.band = span;
  if (has_pole_) {
    for (int k = 0; k < kProbes; ++k) {
      const ToolPose pose = pose_on(span.c, span.length * k / kProbes);
      held.distance[static_cast<std::size_t>(k)] = pole_distance(model_, pose.axis);
    }
  }
  held_.push(held);
}

const BandSpan& PoleCorridor::span_at(double u) const noexcept {
  std::int64_t low = held_.begin_index(), high = held_.end_index();
  while (high - low > 1) {
    const std::int64_t middle = (low + high) / 2;
    (held_[middle].band.u0 <= u ? low : high) = middle;
  }
  return held_[low].band;
}

double PoleCorridor::u_of(Place place) const noexcept {
  const BandSpan& span = held_[place / kProbes].band;
  return span.u0 + span.length * static_cast<double>(place % kProbes) / kProbes;
}

double PoleCorridor::distance_of(Place place) const noexcept {
  return held_[place / kProbes].distance[static_cast<std::size_t>(place % kProbes)];
}

double PoleCorridor::distance_at(double u) const noexcept {
  const BandSpan& span = span_at(u);
  return pole_distance(model_, pose_on(span.c, std::clamp(u - span.u0, 0.0, span.length)).axis);
}

double PoleCorridor::end_u() const noexcept {
  return held_.back().band.u0 + held_.back().band.length;
}

double PoleCorridor::find_nearest(Place place) const noexcept {
  double a = place > held_.begin_index() * kProbes ? u_of(place - 1) : u_of(place);
  double b = place + 1 < end_place() ? u_of(place + 1) : end_u();
  for (int n = 0; n < 60; ++n) {
    const double x = a + 0.382 * (b - a), y = a + 0.618 * (b - a);
    if (distance_at(x) < distance_at(y)) {
      b = y;
    } else {
      a = x;
    }
  }
  return 0.5 * (a + b);
}

double PoleCorridor::find_room_behind(Place from, double core_end) const noexcept {
  double room = std::min(kReach_mm, kReachShare * (end_u() - core_end));
  for (Place n = from + 2; n + 1 < end_place() && u_of(n) < core_end + 2 * kReach_mm; ++n) {
    const double here = distance_of(n);
    const bool is_minimum = here < distance_of(n - 1) && here < distance_of(n + 1);
    if (is_minimum && here < kOtherTolerances * tolerance_rad_) {
      return std::min(room, kHalf * (u_of(n) - core_end));
    }
  }
  return room;
}

void PoleCorridor::add_cut(double u) noexcept {
  if (cut_count_ == kCuts || u <= emitted_u()) return;
  const auto end = cuts_.begin() + static_cast<std::ptrdiff_t>(cut_count_++);
  *end = u;
  std::rotate(std::upper_bound(cuts_.begin(), end, u), end, end + 1);
}

void PoleCorridor::add_cuts(double nearest) noexcept {
  // The free joint turns over a width of distance/|d axis/du|.
  const BandSpan& span = span_at(nearest);
  const auto pose =
      pose_on(span.c, Jet<1>::variable(std::clamp(nearest - span.u0, 0.0, span.length)));
  double rate = 0;
  for (int i = 0; i < 3; ++i) rate += pose.axis[i].derivative(1) * pose.axis[i].derivative(1);
  const double width = distance_at(nearest) / std::max(std::sqrt(rate), 1e-9);
  add_cut(nearest);
  double off = kFirstCut * std::max(width, 1e-5);
  for (int n = 0; n < 28 && off < kFarthestCut_mm; ++n, off *= kCutGrowth) {
    add_cut(nearest - off);
    add_cut(nearest + off);
  }
}

JointVector PoleCorridor::follow_to(double u) const noexcept {
  const int free = free_joint(model_);
  JointVector joints = known_;
  double at = known_u_, step = 0;
  while (at < u) {
    const BandSpan& span = span_at(at);
    const double whole = std::max(span.length / kProbes, kLeastPart_mm);
    step = std::min(step > 0 ? 2 * step : whole, whole);
    for (;; step *= 0.5) {  // so short that a turn of the free joint is seen
      const double next = std::min(u, at + step);
      const BandSpan& there = span_at(next);
      const auto pose = pose_on(there.c, std::clamp(next - there.u0, 0.0, there.length));
      const auto solved = solve(model_, tool_length_mm_, pose, branch_, joints);
      const bool is_there = solved.status != SolveStatus::kUnreachable;
      const bool is_turn =
          is_there && free >= 0 && std::abs(solved.q[free] - joints[free]) > kMostTurn_rad;
      if (is_turn && step > kLeastStep_mm) continue;
      if (is_there) joints = solved.q;
      at = next;
      break;
    }
  }
  return joints;
}

bool PoleCorridor::dwells(Place place) const noexcept {
  return distance_of(place) < kDwellTolerances * tolerance_rad_;
}

bool PoleCorridor::lingers(Place place) const noexcept {
  return distance_of(place) < kStayTolerances * tolerance_rad_;
}

bool PoleCorridor::rests_at(Place place) const noexcept {
  return is_held_ ? lingers(place) : place == 0 && dwells(place);
}

void PoleCorridor::follow_core(Place place) noexcept {
  const Place begin = held_.begin_index() * kProbes;
  if (core_.place != place) {
    core_ = {place, place, place, place, find_nearest(place)};
    const Place first = rests_at(place) ? place : begin;
    while (dwells(place) && core_.first > first && dwells(core_.first - 1)) --core_.first;
  }
  core_.first = std::max(core_.first, begin);  // what is behind may be gone
  if (!is_in_core(place)) return;
  while (core_.seen + 1 < end_place() && lingers(core_.seen + 1)) {
    if (dwells(++core_.seen)) core_.last = core_.seen;
  }
}

bool PoleCorridor::is_known_behind(double u) const noexcept {
  return is_finished_ || held_.is_full() || end_u() > u + 2 * kReach_mm + 1;
}

PoleCorridor::Place PoleCorridor::find_hold(double begin) const noexcept {
  const double length = u_of(core_.last) - begin;
  const bool is_open = !is_finished_ && core_.seen + 1 == end_place();
  if (!is_open || (length < kLongCore_mm && !held_.is_full())) return -1;
  const double end = begin + (held_.is_full() ? 0.5 * length : length - kReach_mm);
  Place place = core_.last;
  while (place > core_.first && (u_of(place) > end || !dwells(place))) --place;
  return u_of(place) > begin + kLeastReach_mm ? place : -1;
}

PolePlace PoleCorridor::place_about(Place place, double left) const noexcept {
  PolePlace around;
  around.core_begin = around.core_end = core_.nearest;
  around.branch = branch_;
  around.is_dwelling = distance_at(core_.nearest) < kPoleEase_rad;
  if (is_in_core(place)) {
    around.is_start = rests_at(place);
    around.is_dwelling = around.is_dwelling || around.is_start || core_.last > core_.first;
    around.core_begin = around.is_start ? left : std::min(core_.nearest, u_of(core_.first));
    around.core_end = std::max(core_.nearest, u_of(core_.last));
  }
  // What rests may end a little farther off than what comes to rest.
  const double nearly_on = around.is_start ? kStayTolerances : kDwellTolerances;
  const Place last = around.is_start ? core_.seen : core_.last;
  if (is_finished_ && last + 1 == end_place() &&
      distance_at(end_u()) < nearly_on * tolerance_rad_) {
    around.is_end = around.is_dwelling = true;
    around.core_end = end_u();
  }
  return around;
}

bool PoleCorridor::decide(Place place) noexcept {
  if (!is_known_behind(u_of(std::max(place - 1, held_.begin_index() * kProbes)))) return false;
  follow_core(place);
  const double left = pending_.begin_index() == pending_.end_index()
                          ? emitted_u()
                          : std::max(emitted_u(), pending_.back().end);
  PolePlace around = place_about(place, left);
  const Place hold = is_in_core(place) && !around.is_end ? find_hold(around.core_begin) : -1;
  if (hold >= 0) {
    around.is_end = around.is_dwelling = true;
    around.core_end = u_of(hold);
  } else if (!is_known_behind(around.core_end)) {
    return false;
  }
  scan_ = std::max(place, core_.last) + 1;  // never back to where nothing is taken
  const bool is_begun = pending_.end_index() > 0 || emitted_u() > 0;
  const bool is_behind = around.is_start ? is_begun && !is_held_ : around.core_begin <= left;
  if (is_behind) return true;
  around.reach = kReach_mm;
  if (!around.is_start) around.reach = kReachShare * (around.core_begin - left);
  if (!around.is_end) {
    around.reach = std::min(around.reach, find_room_behind(core_.last, around.core_end));
  }
  const double nearest = core_.nearest;
  const bool has_room = !pending_.is_full() && around.reach > kLeastReach_mm &&
                        distance_at(nearest) < kZoneTolerances * tolerance_rad_;
  around.known_end = std::min(end_u(), around.core_end + 2 * kReach_mm);
  if (has_room) {
    around.joints = around.is_start ? known_ : follow_to(around.core_begin - around.reach);
    if (find_zone(around, hold >= 0)) {
      if (hold >= 0) scan_ = hold;
      return true;
    }
  }
  has_failed_ = around.is_start;
  add_cuts(nearest);
  return true;
}

bool PoleCorridor::find_zone(PolePlace around, bool is_held) noexcept {
  const PoleTask task{model_, *this, programmed_, tool_length_mm_, tolerance_rad_, is_exact_};
  PoleZone zone = find_pole_zone(task, around);
  const double begin = around.core_begin;
  while (!(zone.end > zone.begin)) {  // hold the free joint farther into the core
    if (!around.is_start || around.is_end) return false;
    around.core_begin = 0.5 * (around.core_begin + around.core_end);
    if (around.core_end - around.core_begin < kLeastHold_mm) return false;
    zone = find_pole_zone(task, around);
  }
  zone.is_held = is_held;
  if (around.core_begin > begin) {
    PolePlace before = around;
    before.core_begin = begin;
    before.core_end = around.core_begin;
    before.is_end = true;
    PoleZone rest = find_pole_zone(task, before);
    if (!(rest.end > rest.begin)) return false;
    rest.is_held = true;
    take(rest);
  }
  take(zone);
  return true;
}

void PoleCorridor::take(const PoleZone& zone) noexcept {
  pending_.push(zone);
  ++zones_;
  branch_ = zone.branch_after;
  known_u_ = zone.end;
  is_held_ = zone.is_held;
  JointVector reference{};
  if (const int free = free_joint(model_); free >= 0) reference[free] = zone.free.back();
  const BandSpan& span = span_at(zone.end);
  const auto pose = pose_on(span.c, std::clamp(zone.end - span.u0, 0.0, span.length));
  known_ = is_held_ ? solve_held(model_, tool_length_mm_, pose, zone.free.back()).q
                    : solve(model_, tool_length_mm_, pose, branch_, reference).q;
}

bool PoleCorridor::is_in_zone() const noexcept {
  return pending_.begin_index() != pending_.end_index() &&
         pending_[pending_.begin_index()].begin < emitted_u() - kLeastPart_mm;
}

bool PoleCorridor::fits_zone(double by) const noexcept {
  constexpr int kSamples = 64;
  if (!is_in_zone()) return true;
  const PoleZone& zone = pending_[pending_.begin_index()];
  for (int n = 0; n <= kSamples; ++n) {
    const double u = emitted_u() + n * (zone.end - emitted_u()) / kSamples;
    const BandSpan& span = span_at(u);
    const double free = quintic_at(zone.free, (u - zone.begin) / (zone.end - zone.begin)) + by;
    const ToolPose pose = pose_on(span.c, std::clamp(u - span.u0, 0.0, span.length));
    const auto at = solve_held(model_, tool_length_mm_, pose, free);
    if (first_joint_outside_travel(model_, at.q, kTravelMargin) >= 0) return false;
  }
  return true;
}

void PoleCorridor::wind(double by, const JointVector& joints) noexcept {
  if (free_joint(model_) < 0) return;
  const bool keeps_zone = is_in_zone();
  PoleZone zone = keeps_zone ? pending_[pending_.begin_index()] : PoleZone{};
  zones_ -= static_cast<int>(pending_.end_index() - pending_.begin_index());
  pending_.drop_before(pending_.end_index());
  cut_count_ = 0;
  scan_ = held_.begin_index() * kProbes;
  entered_ = -1;
  core_ = {};
  if (keeps_zone) {
    for (double& value : zone.free) value += by;
    take(zone);
    return;
  }
  branch_ = out_branch_;
  is_held_ = is_out_held_;
  known_ = joints;
  if (held_.begin_index() != held_.end_index()) known_u_ = emitted_u();
}

bool PoleCorridor::may_emit() const noexcept {
  const Held& front = held_[held_.begin_index()];
  if (!has_pole_) return true;
  if (is_finished_ && scan_ >= end_place()) return true;
  const double end = front.band.u0 + front.band.length;
  const double judged = u_of(std::min(scan_, end_place() - 1));
  if (end > judged) return false;
  const bool is_out_of_reach = *std::min_element(front.distance.begin(), front.distance.end()) >
                               kOutOfReach_rad + front.band.length / kAxisLength_mm_per_rad;
  return is_out_of_reach || held_.is_full() || end <= judged - kReach_mm;
}

void PoleCorridor::emit() noexcept {
  const BandSpan& span = held_[held_.begin_index()].band;
  const double begin = span.u0 + emitted_x_, last = span.u0 + span.length;
  double end = last;
  const auto cut_at = [&](double u) {
    if (u > begin && u < end) end = u;
  };
  const bool has_zone = pending_.begin_index() != pending_.end_index();
  const PoleZone zone = has_zone ? pending_[pending_.begin_index()] : PoleZone{};
  if (has_zone) {
    cut_at(zone.begin);
    cut_at(zone.end);
  }
  std::size_t passed = 0;
  while (passed < cut_count_ && cuts_[passed] < begin + kLeastPart_mm) ++passed;
  std::move(cuts_.begin() + static_cast<std::ptrdiff_t>(passed),
            cuts_.begin() + static_cast<std::ptrdiff_t>(cut_count_), cuts_.begin());
  cut_count_ -= passed;
  if (cut_count_ > 0 && cuts_[0] < end - kLeastPart_mm) cut_at(cuts_[0]);

  const bool is_rest = end == last;
  const double length = is_rest ? span.length - emitted_x_ : end - begin;
  const bool is_whole = is_rest && emitted_x_ == 0;
  out_ = {};
  out_.band = is_whole ? span : part_of_span(span, emitted_x_, length);
  out_.branch = out_branch_;
  const double middle = begin + 0.5 * length;
  if (has_zone && middle > zone.begin && middle < zone.end) {
    const double h = zone.end - zone.begin;
    out_.is_free_driven = true;
    out_.free = part_of(zone.free, begin <= zone.begin ? 0 : (begin - zone.begin) / h,
                        end >= zone.end ? 1 : (end - zone.begin) / h);
    out_.axis_deviation_rad = zone.deviation_rad;
    out_.reason = zone.branch_after != zone.branch_before ? EaseReason::kThrough
                  : zone.deviation_rad < kPoleEase_rad    ? EaseReason::kOnPole
                                                          : EaseReason::kBeside;
  }
  if (has_zone && end >= zone.end) {
    out_branch_ = zone.branch_after;
    is_out_held_ = zone.is_held;
    pending_.drop_before(pending_.begin_index() + 1);
  }
  if (has_pole_ && end > known_u_) {
    known_ = follow_to(end);
    known_u_ = end;
  }
  emitted_x_ += length;
  if (is_rest) {
    emitted_x_ = 0;
    held_.drop_before(held_.begin_index() + 1);
  }
}

const JointSpan* PoleCorridor::next() noexcept {
  if (has_pole_) scan();
  if (has_failed_) return nullptr;
  if (held_.begin_index() == held_.end_index() || !may_emit()) return nullptr;
  emit();
  return &out_;
}

void PoleCorridor::scan() noexcept {
  if (held_.begin_index() == held_.end_index()) return;
  scan_ = std::max(scan_, held_.begin_index() * kProbes);
  while (scan_ < end_place()) {
    const bool is_last = scan_ + 1 == end_place();
    if (is_last && !is_finished_ && !held_.is_full()) return;
    const Place before = std::max(scan_ - 1, held_.begin_index() * kProbes);
    const double here = distance_of(scan_);
    const double behind = is_last ? distance_at(end_u()) : distance_of(scan_ + 1);
    if (!dwells(scan_)) {
      entered_ = -1;
    } else if (entered_ < 0) {
      entered_ = scan_;
    }
    const bool is_long =
        entered_ >= held_.begin_index() * kProbes && u_of(scan_) > u_of(entered_) + 0.5 * kReach_mm;
    const bool is_end = is_last && is_finished_ && behind < kDwellTolerances * tolerance_rad_;
    const bool is_minimum =
        rests_at(scan_) || is_end || is_long ||
        (before < scan_ && here < kNear_rad && here <= distance_of(before) && here < behind);
    if (is_minimum) {
      // Not before a span waits for it: searches are dear, and so no two come at once.
      if (may_emit() && !held_.is_full()) return;
      if (!decide(scan_)) return;
    } else {
      ++scan_;
    }
  }
}

}  // namespace meridian
