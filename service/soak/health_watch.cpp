// SPDX-License-Identifier: Apache-2.0
#include "service/soak/health_watch.hpp"

#include <algorithm>

namespace meridian::soak {
namespace {

constexpr double kWarmUp_s = 10;    ///< of a life
constexpr double kInterval_s = 10;  ///< what first and last are told of

}  // namespace

HealthWatch::HealthWatch(dds::Participant& participant, SoakReport& report)
    : report_(report), latencies_(participant) {}

void HealthWatch::begin_life(double now_s) {
  report_.lives.emplace_back();
  begin_s_ = drift_s_ = now_s;
}

void HealthWatch::look(pid_t service, double now_s) {
  take_latencies(now_s);
  const auto account = process::account_of(service);
  if (!account || report_.lives.empty()) return;
  Life& life = report_.lives.back();
  life.last.process = *account;
  life.most_resident_mib = std::max(life.most_resident_mib, account->resident_mib);
  if (const auto cycle = process::account_of(service, "cycle")) life.last.cycle = *cycle;
  if (const auto publisher = process::account_of(service, "publisher")) {
    life.last.publisher = *publisher;
  }
  if (!life.has_first && now_s - begin_s_ >= kWarmUp_s) {
    life.first = life.last;
    life.has_first = true;
  }
}

void HealthWatch::take_latencies(double now_s) {
  dds::Latency latency;
  bool has_one = false;
  while (latencies_.take(latency)) has_one = true;
  if (!has_one || now_s - drift_s_ < kInterval_s) return;
  drift_s_ = now_s;
  if (latency.service_id != service_id_) before_.clear();
  service_id_ = latency.service_id;
  for (const dds::NamedHistogram& one : latency.histograms) {
    Histogram& before = before_[one.name];
    const Histogram interval = one.histogram.since(before);
    before = one.histogram;
    if (interval.count() == 0) continue;
    Drift& drift = report_.latencies[one.name];
    drift.all.merge(interval);
    if (drift.first.count() == 0) drift.first = interval;
    drift.last = interval;
  }
}

}  // namespace meridian::soak
