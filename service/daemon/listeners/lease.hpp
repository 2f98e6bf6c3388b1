// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "service/daemon/listeners/lease_check.hpp"
#include "service/daemon/ports/set_up_port.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/writer.hpp"

namespace meridian::interpolator {

/// One service per machine: each publishes its claim on the machine topic. One that serves already
/// keeps the machine; of two that start together the one with the smaller service_id goes first. Of
/// two that both serve, because neither heard the other in time, LeaseCheck says which one keeps
/// it; they say for how long they have served twice a second until one has left. One thread.
/// Proof: tests/unit/daemon/lease_test.cpp, tests/integration/lease_test.cpp.
class Lease {
 public:
  using Report = std::function<void(const std::string&)>;
  /// Publishes `claim`. `report` gets what is wrong with the claims of others, once each.
  Lease(dds::Participant& participant, const dds::MachineInfo& claim, Report report = {});

  /// Waits until no other service holds the machine, at most `patience` (a killed service counts as
  /// alive until its lease runs out). Returns the holder if there is one still. `start_window` is
  /// how long to listen for others before the machine is taken to be free.
  [[nodiscard]] std::optional<dds::MachineInfo> find_holder(std::chrono::milliseconds start_window,
                                                            std::chrono::milliseconds patience);
  /// The machine is ours: others hear it.
  void hold();
  /// The set-up from here on, with the text of the tool table; heard at once where `is_reported`.
  void set_up(const WorkFrames& frames, const SetUpInForce& in_force, const std::string& tool_file,
              bool is_reported);
  /// Another service that serves the machine and keeps it, where we heard of it only after hold():
  /// we are to end. To be called several times a second. `may_leave` is false while drives are on:
  /// then there is none. In a dry run none is, so that it gives way as a machine in Off does.
  /// `master`: the service that the drives say that they obey, 0: not known; see LeaseCheck.
  [[nodiscard]] std::optional<dds::MachineInfo> find_keeper(bool may_leave,
                                                            std::uint64_t master = 0);

 private:
  struct Other {
    dds::MachineInfo info;
    std::uint64_t source = 0;  ///< its writer: one says one thing
  };

  void say();
  void look();
  void take(const dds::MachineInfo& info, std::uint64_t source);
  void report_once(std::uint64_t source, const char* what);

  dds::Participant& participant_;
  dds::MachineInfo claim_;
  Report report_;
  dds::Reader<dds::MachineInfo> reader_;
  dds::Writer<dds::MachineInfo> writer_;
  LeaseCheck check_;
  std::vector<Other> others_;                 ///< at most LeaseCheck::kMaxOthers
  std::array<std::uint64_t, 16> reported_{};  ///< writers, in a ring
  std::size_t next_reported_ = 0;
};

}  // namespace meridian::interpolator
