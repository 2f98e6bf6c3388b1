// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "service/core/planner/pole_corridor.hpp"
#include "service/core/planner/pole_time.hpp"

/// Which zones are taken about a core. Part of PoleCorridor.
///
///     core with its excursions ─ zone ─▶ and with the zones of those that end ahead of excursions:
///        │ no zone                       what takes the least time
///        ▼
///     core that ends ahead of the first ─ zone ─▶ taken;     no zone: cuts, or the run ends
namespace meridian {
namespace {

constexpr double kLeastHold_mm = 0.5;
constexpr double kHardlyTurns_rad = 0.1;  // so little of the free joint costs no time
constexpr double kLeastGain_s = 1e-3;

bool is_zone(const PoleZone& zone) noexcept { return zone.end > zone.begin; }

/// The free joint turns no farther than that.
double turn_of(const PoleZone& zone) noexcept {
  const auto [least, most] = std::minmax_element(zone.free.begin(), zone.free.end());
  return *most - *least;
}

}  // namespace

PoleTask PoleCorridor::pole_task() const noexcept {
  return {model_, probes_, programmed_, tool_length_mm_, tolerance_rad_, is_exact_};
}

void PoleCorridor::settle(PoleCore& core) noexcept {
  const Settled before = settled_state();
  if (take_zone(core)) {
    cores_.take(core);
    // Which way carries farther is not asked for the shorter ones, and goes before time.
    const bool is_final = !cores_.is_extended() || !core.around.ahead.empty();
    if (is_final || !is_shorter_faster(core, before)) return;
    go_back(before, before.pending_end);
    (void)cores_.shorten();
    return;
  }
  if (cores_.shorten()) return;
  if (core.around.is_start) {
    has_failed_ = true;
  } else {
    add_cuts(core.nearest);
  }
}

bool PoleCorridor::take_zone(PoleCore& core) noexcept {
  PolePlace& around = core.around;
  const auto waiting = static_cast<std::size_t>(pending_.end_index() - pending_.begin_index());
  if (!core.has_room || waiting + kMostZones > kPending) return false;
  around.joints = around.is_start ? known_ : follow_to(around.core_begin - around.reach);
  return find_zone(around, core.hold >= 0);
}

bool PoleCorridor::find_zone(const PolePlace& around, bool is_held) noexcept {
  Zones zones;
  zones.of[0] = find_pole_zone(pole_task(), around);
  zones.of[0].is_held = is_held;
  zones.count = is_zone(zones.of[0]) ? 1 : 0;
  const bool leads_off = around.is_start && !around.is_end;
  if (leads_off && (zones.count == 0 || turn_of(zones.of[0]) > kHardlyTurns_rad)) {
    hold_on(around, zones);
  }
  for (std::size_t n = 0; n < zones.count; ++n) take(zones.of[n]);
  return zones.count > 0;
}

void PoleCorridor::hold_on(const PolePlace& around, Zones& zones) const noexcept {
  const PoleTask task = pole_task();
  const double end = around.core_end + around.reach;
  const auto time_of = [&](const Zones& way) {
    return find_time(task, {way.of.data(), way.count}, around.branch, around.core_begin, end);
  };
  double least_s = zones.count > 0 ? time_of(zones) : std::numeric_limits<double>::infinity();
  PolePlace rest = around, later = around;
  rest.is_end = true;
  for (;;) {
    later.core_begin = rest.core_end = 0.5 * (later.core_begin + later.core_end);
    if (later.core_end - later.core_begin < kLeastHold_mm) return;
    Zones held{{find_pole_zone(task, rest), find_pole_zone(task, later)}, 2};
    held.of[0].is_held = true;
    if (!is_zone(held.of[0])) return;
    if (!is_zone(held.of[1])) continue;
    if (zones.count > 0 && held.of[1].carries < zones.of[zones.count - 1].carries) continue;
    const double time_s = time_of(held);
    if (!(time_s < least_s - kLeastGain_s)) continue;
    least_s = time_s;
    zones = held;
  }
}

PoleCorridor::Settled PoleCorridor::settled_state(std::int64_t from) const noexcept {
  Settled out{cores_.state(), {}, 0, pending_.end_index(), known_u_, known_, branch_, is_held_};
  for (std::int64_t n = from; n < pending_.end_index() && out.zone_count < out.zones.size(); ++n) {
    out.zones[out.zone_count++] = pending_[n];
  }
  return out;
}

void PoleCorridor::go_back(const Settled& to, std::int64_t from) noexcept {
  while (pending_.end_index() > from) pending_.drop_last();
  for (std::size_t n = 0; n < to.zone_count; ++n) pending_.push(to.zones[n]);
  cores_.go_back(to.cores);
  known_u_ = to.known_u;
  known_ = to.known;
  branch_ = to.branch;
  is_held_ = to.is_held;
}

bool PoleCorridor::try_shorter(double end) noexcept {
  (void)cores_.shorten();
  for (int taken = 0; taken < kMostTried && settled().end < end && cores_.find_next(settled());) {
    PoleCore core;
    const PoleCores::Answer answer = cores_.decide(core);
    if (answer == PoleCores::Answer::kNeedsSpans) return false;
    if (answer == PoleCores::Answer::kPassed) continue;
    if (take_zone(core)) {
      cores_.take(core);
      ++taken;
    } else if (core.around.is_start) {
      return false;
    }
  }
  return true;
}

bool PoleCorridor::is_shorter_faster(const PoleCore& core, const Settled& before) noexcept {
  const std::int64_t from = before.pending_end;
  const Settled extended = settled_state(from);
  go_back(before, from);
  const bool is_whole = try_shorter(extended.known_u);
  const Settled shorter = settled_state(from);
  go_back(extended, from);
  if (!is_whole) return false;
  const PolePlace& around = core.around;
  const double begin = around.core_begin - (around.is_start ? 0 : around.reach);
  const auto time_of = [&](const Settled& way) {  // as far as both are known
    return find_time(pole_task(), {way.zones.data(), way.zone_count}, before.branch, begin,
                     extended.known_u);
  };
  return time_of(shorter) < time_of(extended);
}

}  // namespace meridian
