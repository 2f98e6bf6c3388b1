// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/lease.hpp"

#include <algorithm>
#include <thread>

namespace meridian::interpolator {

Lease::Lease(dds::Participant& participant, const dds::MachineInfo& claim)
    : claim_(claim), reader_(participant), writer_(participant) {
  say();
}

void Lease::hold() {
  claim_.is_serving = true;
  held_ = Clock::now();
  say();
}

Lease::Clock::duration Lease::served() const noexcept {
  return claim_.is_serving ? Clock::now() - held_ : Clock::duration{};
}

void Lease::say() {
  claim_.served_ns = std::chrono::nanoseconds(served()).count();
  (void)writer_.write(claim_);
}

void Lease::take(const dds::MachineInfo& info, std::uint64_t source) {
  auto other = std::find_if(others_.begin(), others_.end(), [&](const Other& known) {
    return known.info.service_id == info.service_id;
  });
  if (other == others_.end()) other = others_.insert(others_.end(), Other{});
  const bool is_met = other->met != Clock::time_point{};
  other->info = info;
  other->source = source;
  other->lead = served() - std::chrono::nanoseconds(info.served_ns);
  if (is_met || !claim_.is_serving || !info.is_serving) return;
  other->met = Clock::now();
  say();
}

void Lease::look() {
  dds::MachineInfo info;
  dds::SampleInfo sample;
  while (reader_.take(info, sample)) {
    if (sample.is_valid && info.service_id != claim_.service_id) take(info, sample.source);
  }
  std::erase_if(others_, [this](const Other& other) { return !reader_.has_source(other.source); });
}

bool Lease::keeps_the_machine(const Other& other) const noexcept {
  const bool goes_first = other.info.service_id < claim_.service_id;
  if (!claim_.is_serving) return other.info.is_serving || goes_first;
  if (!other.info.is_serving) return false;
  if (other.lead < Clock::duration{}) return true;
  return goes_first && other.lead < kSameTime && Clock::now() - other.met > kAnswered;
}

std::optional<dds::MachineInfo> Lease::find_older() {
  look();
  const auto older = std::find_if(others_.begin(), others_.end(),
                                  [this](const Other& other) { return keeps_the_machine(other); });
  if (older == others_.end()) return std::nullopt;
  return older->info;
}

std::optional<dds::MachineInfo> Lease::find_holder(std::chrono::milliseconds start_window,
                                                   std::chrono::milliseconds patience) {
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    const auto holder = find_older();
    const auto waited = std::chrono::steady_clock::now() - start;
    if (!holder && waited >= start_window) return std::nullopt;
    if (holder && waited >= patience) return holder;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace meridian::interpolator
