// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/pole_cores.hpp"

#include <algorithm>

#include "meridian/planner/rest_to_rest.hpp"

namespace meridian {
namespace {

constexpr double kNear_rad = 0.05;  // minima farther off turn the free joint gently
/// A core that is longer than this is not waited for: the free joint comes to rest in it.
constexpr double kLongCore_mm = 2 * kPoleReach_mm;
constexpr double kReachShare = 0.98, kHalf = 0.49;
constexpr double kLeastReach_mm = 1e-3;
constexpr double kLateBegin_mm = 2;  // behind what is settled

}  // namespace

void PoleCores::begin(double tolerance_rad) noexcept {
  tolerance_rad_ = tolerance_rad;
  settled_ = {};
  place_ = 0;
  entered_ = -1;
  run_ = {};
}

void PoleCores::begin_again() noexcept {
  place_ = probes_.begin_place();
  entered_ = -1;
  run_ = {};
}

bool PoleCores::rests_at(Place place) const noexcept {
  return settled_.is_held ? lingers(place) : place == 0 && dwells(place);
}

bool PoleCores::find_next(const SettledPath& settled) noexcept {
  settled_ = settled;
  if (probes_.is_empty()) return false;
  for (place_ = std::max(place_, probes_.begin_place()); place_ < probes_.end_place(); ++place_) {
    const bool is_last = place_ + 1 == probes_.end_place();
    if (is_last && !settled.is_whole && !probes_.is_full()) return false;
    if (!dwells(place_)) {
      entered_ = -1;
    } else if (entered_ < 0) {
      entered_ = place_;
    }
    if (is_minimum(is_last)) return true;
  }
  return false;
}

bool PoleCores::is_minimum(bool is_last) const noexcept {
  const Place begin = probes_.begin_place(), before = std::max(place_ - 1, begin);
  const double here = probes_.distance_of(place_);
  const double behind =
      is_last ? probes_.distance_at(probes_.end_u()) : probes_.distance_of(place_ + 1);
  const bool is_long =
      entered_ >= begin && probes_.u_of(place_) > probes_.u_of(entered_) + 0.5 * kPoleReach_mm;
  const bool is_end = is_last && settled_.is_whole && behind < kDwell * tolerance_rad_;
  return rests_at(place_) || is_end || is_long ||
         (before < place_ && here < kNear_rad && here <= probes_.distance_of(before) &&
          here < behind);
}

void PoleCores::follow(Place place, double stay) noexcept {
  const Place begin = probes_.begin_place();
  if (run_.place != place || run_.stay != stay) {
    run_ = {place, stay, place, place, place, probes_.find_nearest(place)};
    const Place first = rests_at(place) ? place : begin;
    while (dwells(place) && run_.first > first && dwells(run_.first - 1)) --run_.first;
  }
  run_.first = std::max(run_.first, begin);  // what is behind may be gone
  if (!is_in_core(place)) return;
  while (run_.seen + 1 < probes_.end_place() && is_within(run_.seen + 1, stay)) {
    if (dwells(++run_.seen)) run_.last = run_.seen;
  }
}

bool PoleCores::is_known_behind(double u) const noexcept {
  return settled_.is_whole || probes_.is_full() || probes_.end_u() > u + 2 * kPoleReach_mm + 1;
}

PoleCores::Place PoleCores::find_hold(double begin) const noexcept {
  const double length = probes_.u_of(run_.last) - begin;
  const bool is_open = !settled_.is_whole && run_.seen + 1 == probes_.end_place();
  if (!is_open || (length < kLongCore_mm && !probes_.is_full())) return -1;
  const double end = begin + (probes_.is_full() ? 0.5 * length : length - kPoleReach_mm);
  Place place = run_.last;
  while (place > run_.first && (probes_.u_of(place) > end || !dwells(place))) --place;
  return probes_.u_of(place) > begin + kLeastReach_mm ? place : -1;
}

double PoleCores::find_room_behind(double core_end) const noexcept {
  const double room = std::min(kPoleReach_mm, kReachShare * (probes_.end_u() - core_end));
  for (Place n = run_.last + 2;
       n + 1 < probes_.end_place() && probes_.u_of(n) < core_end + 2 * kPoleReach_mm; ++n) {
    const double here = probes_.distance_of(n);
    const bool is_minimum = here < probes_.distance_of(n - 1) && here < probes_.distance_of(n + 1);
    const bool is_core = n > run_.seen && dwells(n);
    if (is_core || (is_minimum && is_within(n, kOther))) {
      return std::min(room, kHalf * (probes_.u_of(n) - core_end));
    }
  }
  return room;
}

PolePlace PoleCores::around() const noexcept {
  PolePlace around;
  around.core_begin = around.core_end = run_.nearest;
  around.branch = settled_.branch;
  around.is_dwelling = probes_.distance_at(run_.nearest) < kPoleEase_rad;
  if (is_in_core(run_.place)) {
    around.is_start = rests_at(run_.place);
    around.is_dwelling = around.is_dwelling || around.is_start || run_.last > run_.first;
    around.core_begin =
        around.is_start ? settled_.end : std::min(run_.nearest, probes_.u_of(run_.first));
    around.core_end = std::max(run_.nearest, probes_.u_of(run_.last));
  }
  // What rests may end a little farther off than what comes to rest.
  const double nearly_on = around.is_start ? kStay : kDwell;
  const Place last = around.is_start ? run_.seen : run_.last;
  if (settled_.is_whole && last + 1 == probes_.end_place() &&
      probes_.distance_at(probes_.end_u()) < nearly_on * tolerance_rad_) {
    around.is_end = around.is_dwelling = true;
    around.core_end = probes_.end_u();
  }
  return around;
}

double PoleCores::find_begin_behind(double u) const noexcept {
  Place low = run_.first, high = run_.last + 1;
  while (low < high) {
    const Place middle = (low + high) / 2;
    if (probes_.u_of(middle) > u + kLateBegin_mm) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  while (low <= run_.last && !dwells(low)) ++low;
  return low <= run_.last ? probes_.u_of(low) : u;
}

PoleCores::Answer PoleCores::decide(PoleCore& out) noexcept {
  return decide_at(place_, kFarStay, out);
}

bool PoleCores::shorten(PoleCore& core) noexcept {
  if (run_.stay <= kStay) return false;
  const Place seen = run_.seen;
  PoleCore closer;
  const Place place = place_;
  const Answer answer = decide_at(run_.place, kStay, closer);
  if (answer != Answer::kFound || run_.seen == seen) {
    place_ = place;
    return false;
  }
  core = closer;
  return true;
}

PoleCores::Answer PoleCores::decide_at(Place place, double stay, PoleCore& out) noexcept {
  if (!is_known_behind(probes_.u_of(std::max(place - 1, probes_.begin_place())))) {
    return Answer::kNeedsSpans;
  }
  follow(place, stay);
  out = {around(), run_.nearest, false, -1};
  PolePlace& around = out.around;
  const bool is_late = is_in_core(place) && !around.is_start && around.core_begin <= settled_.end;
  if (is_late) around.core_begin = find_begin_behind(settled_.end);
  if (is_in_core(place) && !around.is_end) out.hold = find_hold(around.core_begin);
  if (out.hold >= 0) {
    around.is_end = around.is_dwelling = true;
    around.core_end = probes_.u_of(out.hold);
  } else if (!is_known_behind(around.core_end)) {
    return Answer::kNeedsSpans;
  }
  place_ = std::max(place, run_.last) + 1;  // never back to where nothing is taken
  const bool is_passed =
      around.is_start ? settled_.is_begun && !settled_.is_held : around.core_begin <= settled_.end;
  if (is_passed) return Answer::kPassed;
  around.reach = kPoleReach_mm;
  if (!around.is_start) around.reach = kReachShare * (around.core_begin - settled_.end);
  if (!around.is_end) around.reach = std::min(around.reach, find_room_behind(around.core_end));
  around.known_end = std::min(probes_.end_u(), around.core_end + 2 * kPoleReach_mm);
  out.has_room =
      around.reach > kLeastReach_mm && probes_.distance_at(run_.nearest) < kZone * tolerance_rad_;
  return Answer::kFound;
}

}  // namespace meridian
