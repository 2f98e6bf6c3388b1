// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/watch/health_watch.hpp"

#include <algorithm>

#include "meridian/cycle/state_table.hpp"

namespace meridian::soak {
namespace {

constexpr double kWarmUp_s = 10;    ///< of a life
constexpr double kInterval_s = 10;  ///< what first and last are reported of

}  // namespace

HealthWatch::HealthWatch(dds::Participant& participant, SoakReport& report)
    : report_(report), latencies_(participant) {}

void HealthWatch::begin_life(double now_s) {
  report_.lives.emplace_back();
  begin_s_ = drift_s_ = now_s;
}

void HealthWatch::look(pid_t service, double now_s, const dds::Status* status) {
  take_latencies(now_s);
  const auto account = process::account_of(service);
  if (!account || report_.lives.empty()) return;
  Life& life = report_.lives.back();
  life.last.process = *account;
  life.last.threads = process::threads_of(service);
  life.max_resident_mib = std::max(life.max_resident_mib, account->resident_mib);
  if (status != nullptr) {
    life.last.cycles_run = status->cycles_run;
    report_.is_enforced = status->realtime_mode == dds::RealtimeMode::kEnforced;
    const bool is_on = is_enabled(status->state) && status->state != State::kEnabling;
    if (life.ready.empty() && is_on) life.ready = life.last.threads;
  }
  if (!life.has_first && now_s - begin_s_ >= kWarmUp_s) {
    life.first = life.last;
    life.has_first = true;
  }
}

void HealthWatch::take_cutting(double now_s, bool is_cutting) {
  Histogram one;
  one.record(is_cutting ? 1 : 0);
  report_.slices.add(now_s, kCutting, one);
}

void HealthWatch::take_latencies(double now_s) {
  dds::Latency latency;
  bool has_one = false;
  while (latencies_.take(latency)) has_one = true;
  if (!has_one) return;
  if (latency.service_id != service_id_) seen_.clear();
  service_id_ = latency.service_id;
  const bool is_interval = now_s - drift_s_ >= kInterval_s;
  if (is_interval) drift_s_ = now_s;
  for (const dds::NamedHistogram& one : latency.histograms) {
    Drift& drift = report_.latencies[one.name];
    Seen& seen = seen_[one.name];
    // All of it at every look: a service that is killed says no more.
    const Histogram lately = one.histogram.since(seen.last);
    drift.all.merge(lately);
    report_.slices.add(now_s, one.name, lately);
    seen.last = one.histogram;
    if (!is_interval) continue;
    const Histogram interval = one.histogram.since(seen.interval);
    seen.interval = one.histogram;
    if (interval.count() == 0) continue;
    if (drift.first.count() == 0) drift.first = interval;
    drift.last = interval;
  }
}

}  // namespace meridian::soak
