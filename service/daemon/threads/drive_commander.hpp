// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "service/daemon/ports/ports.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/writer.hpp"

namespace meridian::interpolator {

/// Walks the drives through CiA 402 as the machine's state asks: controlwords on change and at
/// 10 Hz. One thread.
class DriveCommander {
 public:
  DriveCommander(dds::Participant& participant, int drive_count, std::uint64_t service_id);

  /// Sends what is due, given what the machine asks for and what the drives say. Drives in fault
  /// are reset for a while after `reset_ns`, when the operator asked for it; 0: never.
  void work(const DrivesAsked& asked, const DriveWords& words, std::int64_t reset_ns,
            std::int64_t now_ns) noexcept;
  [[nodiscard]] std::int32_t writer() const noexcept { return writer_.handle(); }

 private:
  static constexpr std::int64_t kRepeat_ns = 100'000'000;
  static constexpr std::int64_t kReset_ns = 200'000'000;

  dds::Writer<dds::DriveCommand> writer_;
  int drive_count_;
  std::uint64_t service_id_;
  std::array<dds::DriveCommand, kMaxJoints> sent_{};
  std::array<std::int64_t, kMaxJoints> sent_ns_{};
};

}  // namespace meridian::interpolator
