// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/bridge/sent_setpoint.hpp"

namespace meridian::bridge {
namespace {
constexpr std::int64_t kTooOldSetpoint_ns = 100'000'000;
}

void SentSetpoint::follow(std::uint64_t service_id) noexcept {
  if (service_id == 0 || service_id == service_id_) return;
  service_id_ = service_id;
  newest_.reset();
}

bool SentSetpoint::add(const dds::SetpointSample& sample, std::int64_t now_ns) noexcept {
  if ((sample.setpoint.flags & kSetpointDry) != 0 || service_id_ == 0) return false;
  if (sample.crc != dds::setpoint_crc(sample.setpoint, service_id_)) return false;
  newest_ = sample.setpoint;
  time_ns_ = now_ns;
  return true;
}

void SentSetpoint::pass(std::int64_t now_ns) noexcept {
  if (newest_ && now_ns - time_ns_ > kTooOldSetpoint_ns) newest_.reset();
}

}  // namespace meridian::bridge
