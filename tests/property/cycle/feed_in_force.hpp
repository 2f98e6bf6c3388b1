// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "property/cycle/operated_run.hpp"

namespace meridian::test {

/// The largest tip speed of cuts over `feed` times the override that the operator had set last, or
/// before that as long ago as the rate needs to follow.
template <class Run>
[[nodiscard]] double largest_feed(const Run& run, double feed) {
  constexpr double kSettle_s = 0.3;  // of the rate, beside its ramp
  const double ramp_s = run.world.machine.override_ramp_s + kSettle_s;
  std::vector<std::pair<std::uint64_t, double>> set{{0, 1.0}};
  for (const Event& event : run.world.events) {
    const bool is_set = event.code == EventCode::kAccepted &&
                        event.b == static_cast<std::uint64_t>(Verb::kFeedOverride);
    if (is_set) set.emplace_back(event.cycle, event.x);
  }
  double largest = 0;
  std::size_t first = 0, last = 0;
  const auto ramp = static_cast<std::uint64_t>(ramp_s / run.world.dt());
  std::uint64_t last_cycle = 0;
  Vector3 tip = Vector3::Zero();
  for_each_cut(run.world.machine, run.world.records, 0, 1,
               [&](const CycleRecord& record, const ToolPose& pose) {
                 const std::uint64_t cycle = record.setpoint.cycle;
                 while (last + 1 < set.size() && set[last + 1].first <= cycle) ++last;
                 while (first < last && set[first + 1].first + ramp <= cycle) ++first;
                 double factor = 0;
                 for (std::size_t n = first; n <= last; ++n)
                   factor = std::max(factor, set[n].second);
                 const double speed = ((pose.tip - tip).norm() - 1e-11) / run.world.dt();
                 if (cycle == last_cycle + 1 && record.motion == MotionKind::kCut) {
                   largest = std::max(largest, speed / (feed * std::max(factor, 1e-9)));
                 }
                 tip = pose.tip;
                 last_cycle = record.motion == MotionKind::kCut ? cycle : 0;
               });
  return largest;
}

}  // namespace meridian::test
