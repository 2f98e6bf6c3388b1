// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "service/daemon/ports/ports.hpp"
#include "service/daemon/threads/drive_commander.hpp"
#include "service/transport/participant.hpp"

namespace meridian::interpolator {

/// Sends the drives their controlwords, in a thread of its own: nothing that operators, stations or
/// logs do holds back the word that switches them off. The publisher wakes it in the cycle in which
/// the machine asks for something else; what the drives report is looked at every 2 ms.
class DriveCommandThread {
 public:
  DriveCommandThread(dds::Participant& participant, int drive_count, std::uint64_t service_id,
                     Ports& ports);

  /// Runs until Ports::is_stopping.
  void run() noexcept;
  [[nodiscard]] std::int32_t writer() const noexcept { return commander_.writer(); }
  /// Any thread: lets drives in fault be reset for a while, as the operator said.
  void reset_faults(std::int64_t now_ns) noexcept;

 private:
  Ports& ports_;
  DriveCommander commander_;
  std::atomic<std::int64_t> reset_ns_{0};  ///< when it was asked for last
};

}  // namespace meridian::interpolator
