// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "meridian/cycle/histogram.hpp"
#include "service/host/probe/run/drive_side.hpp"
#include "service/host/probe/run/service_setup.hpp"
#include "service/host/probe/turn_figures.hpp"
#include "service/host/process/child_process.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/reader.hpp"

namespace meridian::probe {

/// The real service in Off, running only while it has its turn, with this process as its drives.
/// meridiand lies beside the running program.
class ServiceRun {
 public:
  /// Starts it; `turns` is how many there will be at most.
  ServiceRun(const ServiceSetup& setup, int turns);

  /// Whether setpoints arrive within 10 s of its start.
  [[nodiscard]] bool is_up() const;
  /// A turn in which it sends nothing is one too: its periods are missing in the result.
  void take_turn();
  void pause();

  /// What the turns were.
  struct Result {
    TurnFigures turns;
    std::optional<Histogram> round_trip;  ///< setpoint sent until the drives' answer is here
  };
  /// Ends the service; throws std::runtime_error where it does not end as it should.
  [[nodiscard]] Result end();

 private:
  std::filesystem::path recording_;
  std::int64_t period_ns_;
  DriveSide drive_side_;
  dds::Reader<dds::Latency> latencies_;
  process::ChildProcess process_;
  std::vector<Window> windows_;
};

}  // namespace meridian::probe
