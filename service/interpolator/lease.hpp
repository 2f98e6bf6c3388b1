// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>

#include "service/dds/messages.hpp"
#include "service/dds/reader.hpp"
#include "service/dds/writer.hpp"

namespace meridian::interpolator {

/// One service per machine: each publishes its claim on the machine topic. One that serves already
/// keeps the machine, whatever the clocks say; of two that start together, or that both serve
/// because neither heard the other in time, the later gives way. One thread.
/// Proof: tests/integration/lease_test.cpp.
class Lease {
 public:
  /// Publishes `claim`.
  Lease(dds::Participant& participant, const dds::MachineInfo& claim);

  /// Waits until no other service holds the machine, at most `patience` (a killed service counts as
  /// alive until its lease runs out). Returns the holder if there is one still. `start_window` is
  /// how long to listen for others before the machine is taken to be free.
  [[nodiscard]] std::optional<dds::MachineInfo> find_holder(std::chrono::milliseconds start_window,
                                                            std::chrono::milliseconds patience);
  /// The machine is ours: others hear it.
  void hold();
  /// Another service that serves the machine and has the older claim, where a busy host let us hear
  /// of it only after hold().
  [[nodiscard]] std::optional<dds::MachineInfo> find_older();

 private:
  struct Holder {
    dds::MachineInfo info;
    std::uint64_t source = 0;
  };

  [[nodiscard]] bool goes_before_us(const dds::MachineInfo& other) const noexcept;
  void look();

  dds::MachineInfo claim_;
  dds::Reader<dds::MachineInfo> reader_;
  dds::Writer<dds::MachineInfo> writer_;
  std::optional<Holder> holder_;
};

}  // namespace meridian::interpolator
