// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_stretches.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/planner/rest_to_rest.hpp"
#include "service/core/planner/singular/pole/pole_bounds.hpp"

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
  probe_ = 0;
  run_ = {};
}

void PoleStretches::begin_again() noexcept {
  probe_ = probes_.begin_probe();
  run_ = {};
}

bool PoleStretches::ends_path(ProbeIndex probe) const noexcept {
  return settled_.is_whole && probe + 1 == probes_.end_probe();
}

bool PoleStretches::is_minimum(ProbeIndex probe) const noexcept {
  const double here = probes_.distance_of(probe);
  if (!(here < kNear_rad) || probe == probes_.begin_probe()) return false;
  const bool is_last = probe + 1 == probes_.end_probe();
  const double after =
      is_last ? probes_.distance_at(probes_.end_u()) : probes_.distance_of(probe + 1);
  return here <= probes_.distance_of(probe - 1) && here < after;
}

bool PoleStretches::is_close(ProbeIndex probe) const noexcept {
  const double close = kZoneTolerances * tolerance_rad_;
  if (probes_.distance_of(probe) < close) return true;
  if (ends_path(probe) && probes_.distance_at(probes_.end_u()) < close) return true;
  return is_minimum(probe) && probes_.distance_at(probes_.find_nearest(probe)) < close;
}

bool PoleStretches::find_next(const SettledPath& settled) noexcept {
  settled_ = settled;
  if (probes_.is_empty()) return false;
  probe_ = std::max(probe_, probes_.begin_probe());
  while (probe_ < probes_.end_probe() && probes_.u_of(probe_) < settled.end) ++probe_;
  for (; probe_ < probes_.end_probe(); ++probe_) {
    const bool is_last = probe_ + 1 == probes_.end_probe();
    if (is_last && !settled.is_whole && !probes_.is_full()) return false;
    if (settled.is_held || is_minimum(probe_) || is_close(probe_)) return true;
  }
  return false;
}

bool PoleStretches::is_known_after(double u) const noexcept {
  return settled_.is_whole || probes_.is_full() || probes_.end_u() > u + 2 * kPoleReach_mm + 1;
}

/// Walks on along the stretch from the place: once, however often more of it comes.
void PoleStretches::follow() noexcept {
  if (run_.first != probe_) run_ = {probe_, probe_, probe_, false};
  while (!run_.has_left) {
    const ProbeIndex next = run_.seen + 1;
    const bool is_known =
        next + 1 < probes_.end_probe() || (next + 1 == probes_.end_probe() && settled_.is_whole);
    if (!is_known) return;
    run_.seen = next;
    if (is_close(next)) {
      run_.last = next;
    } else {
      run_.has_left = probes_.distance_of(next) >= kStayTolerances * tolerance_rad_;
    }
  }
}

double PoleStretches::nearest_about(ProbeIndex probe) const noexcept {
  return is_minimum(probe) ? probes_.find_nearest(probe) : probes_.u_of(probe);
}

/// Where a stretch from `begin`, whose end is not known yet, is closest to the pole of what lies
/// well ahead of what is known.
PoleStretches::ProbeIndex PoleStretches::find_hold(double begin) const noexcept {
  const double length = probes_.u_of(run_.seen) - begin;
  const double ahead = std::min(kAhead_mm, kHalf * length);
  const double from = begin + kHalf * (length - ahead), to = begin + length - ahead;
  ProbeIndex best = -1;
  for (ProbeIndex n = run_.seen; n > run_.first && probes_.u_of(n) >= from; --n) {
    if (probes_.u_of(n) > to) continue;
    if (best < 0 || probes_.distance_of(n) < probes_.distance_of(best)) best = n;
  }
  return best;
}

double PoleStretches::find_room_after(double core_end) const noexcept {
  const double room = std::min(kPoleReach_mm, kReachShare * (probes_.end_u() - core_end));
  for (ProbeIndex n = run_.seen;
       n + 1 < probes_.end_probe() && probes_.u_of(n) < core_end + 2 * kPoleReach_mm; ++n) {
    if (is_close(n)) return std::min(room, kHalf * (probes_.u_of(n) - core_end));
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

void PoleStretches::set_begin(PoleStretch& out, double core_begin) const noexcept {
  PolePass& pass = out.pass;
  pass.begin = settled_.end;
  if (settled_.is_held) {
    pass.at_begin = PoleJoin::kHeld;
    return;
  }
  if (!settled_.is_begun && core_begin < settled_.end + kPoleReach_mm) {
    pass.at_begin = PoleJoin::kRest;
    return;
  }
  const double reach = std::min(kPoleReach_mm, kReachShare * (core_begin - settled_.end));
  pass.begin = snapped(core_begin - reach);
  out.has_room = out.has_room && reach > kMinReach_mm;
}

PoleStretches::Answer PoleStretches::decide(PoleStretch& out) noexcept {
  if (!is_known_after(probes_.u_of(std::max(probe_ - 1, probes_.begin_probe())))) {
    return Answer::kNeedsSpans;
  }
  out = {};
  out.first = out.last = probe_;
  out.nearest = nearest_about(probe_);
  out.pass.branch = settled_.branch;
  if (!settled_.is_held && !is_close(probe_)) {
    ++probe_;
    return out.nearest > settled_.end ? Answer::kFound : Answer::kPassed;
  }
  follow();
  const double core_begin =
      settled_.is_held ? settled_.end : std::min(out.nearest, probes_.u_of(probe_));
  out.has_room = true;
  out.close_begin = core_begin;
  set_begin(out, core_begin);
  PolePass& pass = out.pass;
  const bool is_open = !run_.has_left && !settled_.is_whole;
  if (is_open) {
    const double length = probes_.u_of(run_.seen) - core_begin;
    const bool is_waited_for = length < kLongStretch_mm && !probes_.is_full();
    const ProbeIndex hold = is_waited_for ? -1 : find_hold(pass.begin);
    if (is_waited_for) return Answer::kNeedsSpans;
    out.has_room = out.has_room && hold >= 0;
    out.last = hold >= 0 ? hold : run_.seen;
    pass.at_end = PoleJoin::kHeld;
    pass.end = probes_.u_of(out.last);
    pass.seen_end = probes_.u_of(run_.seen);
    pass.known_end = pass.seen_end;
  } else {
    out.last = run_.last;
    const double core_end = std::max(probes_.u_of(run_.last), nearest_about(run_.last));
    if (!is_known_after(core_end)) return Answer::kNeedsSpans;
    out.close_end = core_end;
    set_end(out, core_end);
  }
  probe_ = out.last + 1;
  const bool is_passed = pass.at_begin == PoleJoin::kExact && core_begin <= settled_.end;
  return is_passed ? Answer::kPassed : Answer::kFound;
}

void PoleStretches::set_end(PoleStretch& out, double core_end) const noexcept {
  PolePass& pass = out.pass;
  pass.known_end = std::min(probes_.end_u(), core_end + 2 * kPoleReach_mm);
  const bool is_end =
      ends_path(run_.last) || (settled_.is_whole && run_.seen + 1 == probes_.end_probe());
  const double end = probes_.distance_at(probes_.end_u());
  if (is_end && end < kStayTolerances * tolerance_rad_) {
    pass.at_end = PoleJoin::kRest;
    pass.end = probes_.end_u();
    return;
  }
  const double room = find_room_after(core_end);
  pass.end = snapped(core_end + room);
  out.has_room = out.has_room && room > kMinReach_mm;
}

bool PoleStretches::narrow_onto_end(PoleStretch& stretch) const noexcept {
  constexpr double kShare = 0.4, kMin_mm = 5e-4;
  const double end = stretch.pass.end, close = kZoneTolerances * tolerance_rad_;
  double& begin = stretch.close_begin;
  bool is_nearer = false;
  do {
    const double length = kShare * (end - begin);
    if (length < kMin_mm) break;
    begin = end - length;
    is_nearer = true;
  } while (probes_.distance_at(begin) > close);
  return is_nearer;
}

bool PoleStretches::shorten(PoleStretch& stretch, double reach_mm) const noexcept {
  PolePass& pass = stretch.pass;
  const double begin = snapped(stretch.close_begin - reach_mm);
  const double end = snapped(stretch.close_end + reach_mm);
  const bool begins_later = pass.at_begin != PoleJoin::kHeld && begin > pass.begin + kMinReach_mm;
  const bool ends_earlier = pass.at_end == PoleJoin::kExact && end < pass.end - kMinReach_mm;
  if (begins_later) {
    pass.begin = begin;
    pass.at_begin = PoleJoin::kExact;
  }
  if (ends_earlier) pass.end = end;
  return begins_later || ends_earlier;
}

}  // namespace meridian
