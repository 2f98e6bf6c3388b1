// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/lease.hpp"

#include <thread>
#include <tuple>

namespace meridian::interpolator {

Lease::Lease(dds::Participant& participant, const dds::MachineInfo& claim)
    : claim_(claim), reader_(participant), writer_(participant) {
  (void)writer_.write(claim_);
}

bool Lease::goes_before_us(const dds::MachineInfo& other) const noexcept {
  const bool is_older =
      std::tie(other.started_ns, other.service_id) < std::tie(claim_.started_ns, claim_.service_id);
  return claim_.is_serving ? other.is_serving && is_older : other.is_serving || is_older;
}

void Lease::hold() {
  claim_.is_serving = true;
  (void)writer_.write(claim_);
}

void Lease::look() {
  dds::MachineInfo info;
  dds::SampleInfo sample;
  while (reader_.take(info, sample)) {
    if (!sample.is_valid || info.service_id == claim_.service_id || !goes_before_us(info)) continue;
    holder_ = Holder{info, sample.source};
  }
  if (holder_ && !reader_.has_source(holder_->source)) holder_.reset();
}

std::optional<dds::MachineInfo> Lease::find_older() {
  look();
  if (!holder_) return std::nullopt;
  return holder_->info;
}

std::optional<dds::MachineInfo> Lease::find_holder(std::chrono::milliseconds start_window,
                                                   std::chrono::milliseconds patience) {
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    look();
    const auto waited = std::chrono::steady_clock::now() - start;
    if (!holder_ && waited >= start_window) return std::nullopt;
    if (holder_ && waited >= patience) return holder_->info;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace meridian::interpolator
