// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/pole_cores.hpp"

#include <algorithm>

#include "meridian/planner/rest_to_rest.hpp"
#include "service/core/planner/pole_bounds.hpp"

namespace meridian {
namespace {

constexpr double kNear_rad = 0.05;        // minima farther off turn the free joint gently
constexpr double kStayTolerances = 0.4;   // so far a path that comes back may go meanwhile
constexpr double kFreeTolerances = 0.99;  // the same where it is known how far off the axis comes
/// A core that is longer than this is not waited for: the free joint comes to rest in it.
constexpr double kLongCore_mm = 2 * kPoleReach_mm;
constexpr double kReachShare = 0.98, kHalf = 0.49;
constexpr double kLeastReach_mm = 1e-3;

}  // namespace

void PoleCores::begin(double tolerance_rad, bool is_exact) noexcept {
  tolerance_rad_ = tolerance_rad;
  is_exact_ = is_exact;
  shortened_ = -1;
  settled_ = {};
  place_ = 0;
  entered_ = -1;
  run_ = {};
}

void PoleCores::begin_again() noexcept {
  shortened_ = -1;
  place_ = probes_.begin_place();
  entered_ = -1;
  run_ = {};
}

bool PoleCores::dwells(Place place) const noexcept {
  return probes_.distance_of(place) < kOnPoleTolerances * tolerance_rad_;
}

bool PoleCores::lingers(Place place) const noexcept {
  return probes_.distance_of(place) < kStayTolerances * tolerance_rad_;
}

bool PoleCores::is_free(Place place) const noexcept {
  return !is_exact_ && probes_.distance_of(place) < tolerance_rad_ &&
         freedom_.is_below(kFreeTolerances * tolerance_rad_, place);
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
  const bool is_end = is_last && settled_.is_whole && behind < kOnPoleTolerances * tolerance_rad_;
  return rests_at(place_) || is_end || is_long ||
         (before < place_ && here < kNear_rad && here <= probes_.distance_of(before) &&
          here < behind);
}

void PoleCores::follow() noexcept {
  const Place begin = probes_.begin_place();
  if (run_.place != place_) {
    run_ = {place_, place_, place_, place_, probes_.find_nearest(place_)};
    const Place first = rests_at(place_) ? place_ : begin;
    while (dwells(place_) && run_.first > first && dwells(run_.first - 1)) --run_.first;
  }
  run_.first = std::max(run_.first, begin);  // what is behind may be gone
  if (!is_in_core(place_) && !(may_extend() && is_free(place_))) return;
  while (run_.seen + 1 < probes_.end_place()) {
    const Place next = run_.seen + 1;
    if (!lingers(next) && !(may_extend() && is_free(next))) return;
    extend_to(next);
  }
}

void PoleCores::extend_to(Place next) noexcept {
  const Place here = run_.seen;
  const bool begins_beside = !dwells(run_.place) && !rests_at(run_.place);
  const bool is_nearest = here > run_.place && !dwells(here) &&
                          probes_.distance_of(here) <= probes_.distance_of(here - 1) &&
                          probes_.distance_of(here) < probes_.distance_of(next);
  if (is_nearest && may_extend()) {
    run_.last = here;
    run_.is_extended = true;
  }
  run_.seen = next;
  run_.has_left = run_.has_left || !lingers(next);
  if (!dwells(next)) return;
  run_.last = next;
  run_.is_extended = run_.is_extended || run_.has_left || begins_beside;
}

void PoleCores::go_back(const State& to) noexcept {
  settled_ = to.settled;
  place_ = to.place;
  entered_ = to.entered;
  shortened_ = to.shortened;
  run_ = to.run;
}

bool PoleCores::shorten() noexcept {
  if (!run_.is_extended) return false;
  place_ = shortened_ = run_.place;
  run_.place = -1;
  return true;
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
  const auto may_rest = [this](Place at) { return run_.is_extended ? lingers(at) : dwells(at); };
  while (place > run_.first && (probes_.u_of(place) > end || !may_rest(place))) --place;
  if (run_.is_extended && !may_rest(place)) return -1;
  return probes_.u_of(place) > begin + kLeastReach_mm ? place : -1;
}

double PoleCores::find_room_behind(double core_end) const noexcept {
  const double room = std::min(kPoleReach_mm, kReachShare * (probes_.end_u() - core_end));
  for (Place n = run_.last + 2;
       n + 1 < probes_.end_place() && probes_.u_of(n) < core_end + 2 * kPoleReach_mm; ++n) {
    const double here = probes_.distance_of(n);
    const bool is_minimum = here < probes_.distance_of(n - 1) && here < probes_.distance_of(n + 1);
    if (is_minimum && here < kOtherTolerances * tolerance_rad_) {
      return std::min(room, kHalf * (probes_.u_of(n) - core_end));
    }
  }
  const bool ends_on_pole = settled_.is_whole && probes_.distance_at(probes_.end_u()) <
                                                     kOnPoleTolerances * tolerance_rad_;
  return ends_on_pole ? std::min(room, kHalf * (find_last_way_onto() - core_end)) : room;
}

double PoleCores::find_last_way_onto() const noexcept {
  double begin = probes_.end_u();
  for (Place n = probes_.end_place() - 1; n > run_.last && dwells(n); --n) begin = probes_.u_of(n);
  return begin;
}

PolePlace PoleCores::around() const noexcept {
  PolePlace around;
  around.core_begin = around.core_end = run_.nearest;
  around.branch = settled_.branch;
  around.is_dwelling = probes_.distance_at(run_.nearest) < kPoleEase_rad;
  if (is_in_core(place_)) {
    around.is_start = rests_at(place_);
    around.is_dwelling = around.is_dwelling || around.is_start || run_.last > run_.first;
    around.core_begin =
        around.is_start ? settled_.end : std::min(run_.nearest, probes_.u_of(run_.first));
    around.core_end = std::max(run_.nearest, probes_.u_of(run_.last));
  }
  // What rests may end a little farther off than what comes to rest.
  const double nearly_on = around.is_start ? kStayTolerances : kOnPoleTolerances;
  const Place last = around.is_start ? run_.seen : run_.last;
  if (settled_.is_whole && last + 1 == probes_.end_place() &&
      probes_.distance_at(probes_.end_u()) < nearly_on * tolerance_rad_) {
    around.is_end = around.is_dwelling = true;
    around.core_end = probes_.end_u();
  }
  return around;
}

PoleCores::Answer PoleCores::decide(PoleCore& out) noexcept {
  if (!is_known_behind(probes_.u_of(std::max(place_ - 1, probes_.begin_place())))) {
    return Answer::kNeedsSpans;
  }
  follow();
  out = {around(), run_.nearest, false, -1};
  PolePlace& around = out.around;
  if (is_in_core(place_) && !around.is_end) out.hold = find_hold(around.core_begin);
  if (out.hold >= 0) {
    around.is_end = around.is_dwelling = true;
    around.core_end = probes_.u_of(out.hold);
  } else if (!is_known_behind(around.core_end)) {
    return Answer::kNeedsSpans;
  }
  place_ = std::max(place_, run_.last) + 1;  // never back to where nothing is taken
  const bool is_passed =
      around.is_start ? settled_.is_begun && !settled_.is_held : around.core_begin <= settled_.end;
  if (is_passed) return Answer::kPassed;
  around.reach = kPoleReach_mm;
  if (!around.is_start) around.reach = kReachShare * (around.core_begin - settled_.end);
  if (!around.is_end) around.reach = std::min(around.reach, find_room_behind(around.core_end));
  around.known_end = std::min(probes_.end_u(), around.core_end + 2 * kPoleReach_mm);
  out.has_room = around.reach > kLeastReach_mm &&
                 probes_.distance_at(run_.nearest) < kZoneTolerances * tolerance_rad_;
  return Answer::kFound;
}

}  // namespace meridian
