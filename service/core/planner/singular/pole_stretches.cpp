// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole_stretches.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/planner/rest_to_rest.hpp"
#include "service/core/planner/singular/pole_bounds.hpp"

namespace meridian {
namespace {

constexpr double kNear_rad = 0.05;     // minima farther off turn the redundant joint gently
constexpr double kStayTolerances = 5;  // so far a path that comes back may go meanwhile
/// A stretch that is longer than this is not waited for: it goes on behind a place in it.
constexpr double kLongStretch_mm = 4 * kPoleReach_mm;
constexpr double kAhead_mm = 2 * kPoleReach_mm;  // so much of it is known behind that place
constexpr double kReachShare = 0.98, kHalf = 0.49;
constexpr double kMinReach_mm = 1e-3;
constexpr double kSnapped_mm = 1e-4;

}  // namespace

void PoleStretches::begin(double tolerance_rad) noexcept {
  tolerance_rad_ = tolerance_rad;
  settled_ = {};
  place_ = 0;
  run_ = {};
}

void PoleStretches::begin_again() noexcept {
  place_ = probes_.begin_place();
  run_ = {};
}

bool PoleStretches::ends_path(Place place) const noexcept {
  return settled_.is_whole && place + 1 == probes_.end_place();
}

bool PoleStretches::is_minimum(Place place) const noexcept {
  const double here = probes_.distance_of(place);
  if (!(here < kNear_rad) || place == probes_.begin_place()) return false;
  const bool is_last = place + 1 == probes_.end_place();
  const double behind =
      is_last ? probes_.distance_at(probes_.end_u()) : probes_.distance_of(place + 1);
  return here <= probes_.distance_of(place - 1) && here < behind;
}

bool PoleStretches::is_close(Place place) const noexcept {
  const double close = kZoneTolerances * tolerance_rad_;
  if (probes_.distance_of(place) < close) return true;
  if (ends_path(place) && probes_.distance_at(probes_.end_u()) < close) return true;
  return is_minimum(place) && probes_.distance_at(probes_.find_nearest(place)) < close;
}

bool PoleStretches::find_next(const SettledPath& settled) noexcept {
  settled_ = settled;
  if (probes_.is_empty()) return false;
  place_ = std::max(place_, probes_.begin_place());
  while (place_ < probes_.end_place() && probes_.u_of(place_) < settled.end) ++place_;
  for (; place_ < probes_.end_place(); ++place_) {
    const bool is_last = place_ + 1 == probes_.end_place();
    if (is_last && !settled.is_whole && !probes_.is_full()) return false;
    if (settled.is_held || is_minimum(place_) || is_close(place_)) return true;
  }
  return false;
}

bool PoleStretches::is_known_behind(double u) const noexcept {
  return settled_.is_whole || probes_.is_full() || probes_.end_u() > u + 2 * kPoleReach_mm + 1;
}

/// Walks on along the stretch from the place: once, however often more of it comes.
void PoleStretches::follow() noexcept {
  if (run_.first != place_) run_ = {place_, place_, place_, false};
  while (!run_.has_left) {
    const Place next = run_.seen + 1;
    const bool is_known =
        next + 1 < probes_.end_place() || (next + 1 == probes_.end_place() && settled_.is_whole);
    if (!is_known) return;
    run_.seen = next;
    if (is_close(next)) {
      run_.last = next;
    } else {
      run_.has_left = probes_.distance_of(next) >= kStayTolerances * tolerance_rad_;
    }
  }
}

double PoleStretches::nearest_about(Place place) const noexcept {
  return is_minimum(place) ? probes_.find_nearest(place) : probes_.u_of(place);
}

/// Where a stretch from `begin`, whose end is not known yet, is closest to the pole of what lies
/// well ahead of what is known.
PoleStretches::Place PoleStretches::find_hold(double begin) const noexcept {
  const double length = probes_.u_of(run_.seen) - begin;
  const double ahead = std::min(kAhead_mm, kHalf * length);
  const double from = begin + kHalf * (length - ahead), to = begin + length - ahead;
  Place best = -1;
  for (Place n = run_.seen; n > run_.first && probes_.u_of(n) >= from; --n) {
    if (probes_.u_of(n) > to) continue;
    if (best < 0 || probes_.distance_of(n) < probes_.distance_of(best)) best = n;
  }
  return best;
}

double PoleStretches::find_room_behind(double core_end) const noexcept {
  const double room = std::min(kPoleReach_mm, kReachShare * (probes_.end_u() - core_end));
  for (Place n = run_.last + 1;
       n + 1 < probes_.end_place() && probes_.u_of(n) < core_end + 2 * kPoleReach_mm; ++n) {
    if (n > run_.seen && is_close(n)) return std::min(room, kHalf * (probes_.u_of(n) - core_end));
  }
  return room;
}

/// `u`, or the end of a span that is so close that the part between would be none.
double PoleStretches::snapped(double u) const noexcept {
  const BandSpan& span = probes_.span_at(u);
  if (std::abs(u - span.u0) < kSnapped_mm) return span.u0;
  const double end = span.u0 + span.length;
  return std::abs(end - u) < kSnapped_mm ? end : u;
}

void PoleStretches::place_begin(PoleStretch& out, double core_begin) const noexcept {
  PolePlace& place = out.place;
  place.begin = settled_.end;
  if (settled_.is_held) {
    place.at_begin = PoleJoin::kHeld;
    return;
  }
  if (!settled_.is_begun && core_begin < settled_.end + kPoleReach_mm) {
    place.at_begin = PoleJoin::kRest;
    return;
  }
  const double reach = std::min(kPoleReach_mm, kReachShare * (core_begin - settled_.end));
  place.begin = snapped(core_begin - reach);
  out.has_room = out.has_room && reach > kMinReach_mm;
}

PoleStretches::Answer PoleStretches::decide(PoleStretch& out) noexcept {
  if (!is_known_behind(probes_.u_of(std::max(place_ - 1, probes_.begin_place())))) {
    return Answer::kNeedsSpans;
  }
  out = {};
  out.first = out.last = place_;
  out.nearest = nearest_about(place_);
  out.place.branch = settled_.branch;
  if (!settled_.is_held && !is_close(place_)) {
    ++place_;
    return out.nearest > settled_.end ? Answer::kFound : Answer::kPassed;
  }
  follow();
  const double core_begin =
      settled_.is_held ? settled_.end : std::min(out.nearest, probes_.u_of(place_));
  out.has_room = true;
  out.close_begin = core_begin;
  place_begin(out, core_begin);
  PolePlace& place = out.place;
  const bool is_open = !run_.has_left && !settled_.is_whole;
  if (is_open) {
    const double length = probes_.u_of(run_.seen) - core_begin;
    const bool is_waited_for = length < kLongStretch_mm && !probes_.is_full();
    const Place hold = is_waited_for ? -1 : find_hold(place.begin);
    if (is_waited_for) return Answer::kNeedsSpans;
    out.has_room = out.has_room && hold >= 0;
    out.last = hold >= 0 ? hold : run_.seen;
    place.at_end = PoleJoin::kHeld;
    place.end = probes_.u_of(out.last);
    place.seen_end = probes_.u_of(run_.seen);
    place.known_end = place.seen_end;
  } else {
    out.last = run_.last;
    const double core_end = std::max(probes_.u_of(run_.last), nearest_about(run_.last));
    if (!is_known_behind(core_end)) return Answer::kNeedsSpans;
    out.close_end = core_end;
    place_end(out, core_end);
  }
  place_ = out.last + 1;
  const bool is_passed = place.at_begin == PoleJoin::kExact && core_begin <= settled_.end;
  return is_passed ? Answer::kPassed : Answer::kFound;
}

void PoleStretches::place_end(PoleStretch& out, double core_end) const noexcept {
  PolePlace& place = out.place;
  place.known_end = std::min(probes_.end_u(), core_end + 2 * kPoleReach_mm);
  const bool is_end =
      ends_path(run_.last) || (settled_.is_whole && run_.seen + 1 == probes_.end_place());
  const double end = probes_.distance_at(probes_.end_u());
  if (is_end && end < kStayTolerances * tolerance_rad_) {
    place.at_end = PoleJoin::kRest;
    place.end = probes_.end_u();
    return;
  }
  const double room = find_room_behind(core_end);
  place.end = snapped(core_end + room);
  out.has_room = out.has_room && room > kMinReach_mm;
}

bool PoleStretches::shorten(PoleStretch& stretch, double reach_mm) const noexcept {
  PolePlace& place = stretch.place;
  const double begin = snapped(stretch.close_begin - reach_mm);
  const double end = snapped(stretch.close_end + reach_mm);
  const bool begins_later = place.at_begin != PoleJoin::kHeld && begin > place.begin + kMinReach_mm;
  const bool ends_earlier = place.at_end == PoleJoin::kExact && end < place.end - kMinReach_mm;
  if (begins_later) {
    place.begin = begin;
    place.at_begin = PoleJoin::kExact;
  }
  if (ends_earlier) place.end = end;
  return begins_later || ends_earlier;
}

}  // namespace meridian
