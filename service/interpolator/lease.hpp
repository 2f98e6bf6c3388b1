// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "service/dds/messages.hpp"
#include "service/dds/reader.hpp"
#include "service/dds/writer.hpp"

namespace meridian::interpolator {

/// One service per machine: each publishes its claim on the machine topic. One that serves already
/// keeps the machine; of two that start together the one with the smaller service_id goes first. Of
/// two that both serve, because neither heard the other in time, the one that has served longer
/// keeps it. Each says for how long, by its own clock, when it hears of the other: the clocks of
/// two hosts are never compared. Within kSameTime the smaller service_id decides. One thread.
/// Proof: tests/unit/interpolator/lease_test.cpp, tests/integration/lease_test.cpp.
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
  /// Another service that serves the machine and keeps it, where we heard of it only after hold().
  /// Call it now and then: that answers a service which asks for how long we have served.
  [[nodiscard]] std::optional<dds::MachineInfo> find_older();

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kSameTime{1};
  static constexpr std::chrono::seconds kAnswered{2};  ///< by then both have said for how long

  struct Other {
    dds::MachineInfo info;
    std::uint64_t source = 0;
    Clock::time_point met{};  ///< when both served first
    Clock::duration lead{};   ///< by which we had served longer when it last said so
  };

  void say();
  void look();
  void take(const dds::MachineInfo& info, std::uint64_t source);
  [[nodiscard]] Clock::duration served() const noexcept;
  [[nodiscard]] bool keeps_the_machine(const Other& other) const noexcept;

  dds::MachineInfo claim_;
  dds::Reader<dds::MachineInfo> reader_;
  dds::Writer<dds::MachineInfo> writer_;
  std::vector<Other> others_;
  Clock::time_point held_{};
};

}  // namespace meridian::interpolator
