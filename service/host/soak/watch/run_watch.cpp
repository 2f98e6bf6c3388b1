// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/watch/run_watch.hpp"

#include <algorithm>

#include "service/drives/kit/csp/cia402.hpp"
#include "service/protocol/steady_ns.hpp"

namespace meridian::soak {
RunWatch::RunWatch(dds::Participant& participant, const MachineModel& model, SoakReport& report)
    : report_(report),
      health_(participant, report),
      feedback_reader_(participant, {}, kFeedbackDepth),
      bridge_ns_(model.bridge_cycles * model.cycle_ns),
      host_(bridge_ns_),
      faults_(static_cast<double>(bridge_ns_) * 1e-9),
      credit_(model.cycle_ns, HostWatch::nap_ns(bridge_ns_)) {
  report_.host_nap_ns = HostWatch::nap_ns(bridge_ns_);
}

void RunWatch::begin_life(double now_s) {
  health_.begin_life(now_s);
  newest_.reset();
  faults_.lose_service();
}

std::optional<FaultCheck::Cause> RunWatch::see(const dds::Status& status, double now_s) {
  newest_ = status;
  count(status, now_s);
  constexpr std::int64_t kMemory_ns = FaultCheck::kStallsOf_ns + FaultCheck::kLongestStop_ns;
  const Witness witness{host_.stalls_since(status.time_ns - kMemory_ns), host_.is_watching(),
                        misses_setpoints()};
  return faults_.see(status, now_s, witness);
}

void RunWatch::count(const dds::Status& status, double now_s) {
  const std::uint64_t lost = report_.periods_lost, overruns = report_.overruns;
  counts_.add(status, report_);
  const Histogram late = host_.lateness(report_.cpu), lately = late.since(bare_);
  bare_ = late;
  credit_.add(now_s, lately);
  report_.periods_lost_to_host += credit_.explain(now_s, report_.periods_lost - lost);
  report_.overruns_by_host +=
      excuse_.explain(now_s, report_.overruns - overruns, has_stall_of_late());
  health_.take_bare(now_s, lately);
  health_.take_cutting(now_s, is_moving(status.state));
}

bool RunWatch::has_stall_of_late() const {
  constexpr auto kNear_ns = static_cast<std::int64_t>(1e9 * OverrunExcuse::kNear_s);
  return std::ranges::any_of(
      host_.stalls_since(stream::steady_ns() - kNear_ns),
      [](const Stall& one) { return one.length_ns >= HostWatch::kStall_ns; });
}

/// Whether a drive has stopped because setpoints stayed away.
bool RunWatch::misses_setpoints() {
  while (feedback_reader_.take(feedback_)) continue;
  return std::ranges::find(feedback_.error, drive::kErrorSetpointsStopped) != feedback_.error.end();
}

void RunWatch::look(pid_t service, double now_s) {
  health_.look(service, now_s, newest_ ? &*newest_ : nullptr);
}

void RunWatch::report_host() {
  report_.is_host_watched = host_.is_watching();
  report_.host_stalls = host_.stalls();
  report_.host_longest_s = host_.longest_s();
}

}  // namespace meridian::soak
