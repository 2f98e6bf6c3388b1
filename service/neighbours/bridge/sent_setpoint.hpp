// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "service/transport/convert/messages.hpp"

namespace meridian::bridge {

/// The newest setpoint that the drives follow: of the service that they obey, with its checksum. It
/// counts for nothing when it is older than 0.1 s: a service that is gone leaves no velocity
/// behind. Proof: tests/unit/bridge/sent_setpoint_test.cpp.
class SentSetpoint {
 public:
  /// `service_id`: whom the drives obey; 0: they do not say, the last one stays.
  void follow(std::uint64_t service_id) noexcept;
  /// Returns whether it is used. One of a dry run is not: nobody follows it.
  bool add(const dds::SetpointSample& sample, std::int64_t now_ns) noexcept;
  /// Forgets what is too old.
  void pass(std::int64_t now_ns) noexcept;
  [[nodiscard]] const std::optional<Setpoint>& get() const noexcept { return newest_; }

 private:
  std::uint64_t service_id_ = 0;
  std::optional<Setpoint> newest_;
  std::int64_t time_ns_ = 0;
};

}  // namespace meridian::bridge
