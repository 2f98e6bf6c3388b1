// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/threads/drive_command_thread.hpp"

#include "service/daemon/ports/monotonic.hpp"

namespace meridian::interpolator {

DriveCommandThread::DriveCommandThread(dds::Participant& participant, int drive_count,
                                       std::uint64_t service_id, Ports& ports)
    : ports_(ports), commander_(participant, drive_count, service_id) {}

void DriveCommandThread::reset_faults(std::int64_t now_ns) noexcept {
  reset_ns_.store(now_ns, std::memory_order_relaxed);
  ports_.drives_wake.notify();
}

void DriveCommandThread::run() noexcept {
  constexpr std::int64_t kLookAtDrives_ns = 2'000'000;
  while (!ports_.is_stopping.load(std::memory_order_relaxed)) {
    const std::uint32_t seen = ports_.drives_wake.look();
    ports_.drives_asked.refresh();
    ports_.drive_words_for_commands.refresh();
    commander_.work(ports_.drives_asked.latest(), ports_.drive_words_for_commands.latest(),
                    reset_ns_.load(std::memory_order_relaxed), monotonic_ns());
    ports_.drives_wake.wait(seen, kLookAtDrives_ns);
  }
}

}  // namespace meridian::interpolator
