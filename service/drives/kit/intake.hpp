// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "meridian/cycle/spsc_ring.hpp"
#include "service/drives/kit/foreign_sources.hpp"
#include "service/drives/kit/receiver.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/sources.hpp"

namespace meridian::drive {

/// Drive commands and setpoints from the wire to who takes them. They are read as they arrive, on
/// Cyclone's receive threads, and what is not of the master is dropped there: a flood of others'
/// samples hides none of the master's. Two threads may share it: one works the drives, the other
/// one asks DDS who is there. Proof: tests/unit/simulated_drives/simulated_drives_test.cpp.
class Intake {
 public:
  using Report = std::function<void(const std::string&)>;
  /// `report` outlives this; look() calls it.
  Intake(dds::Participant& participant, const Report& report);

  /// The drives' thread, once a period: passes on what came and whether the master is there.
  /// RT: no heap call, nothing waits.
  void receive(Receiver& receiver) noexcept;
  /// Now and then, at best every period: whether the master is there, how many lost setpoints
  /// services want bridged; reports by name who was dropped. Makes heap calls.
  void look(std::int64_t now_ns);
  /// Adds what was dropped here, and not by the receiver.
  void add_dropped(DropCounts& counts) const noexcept;

 private:
  template <class Message>
  struct Arrived {
    Message message;
    std::uint64_t source = 0, participant = 0;
    std::int64_t arrival_ns = 0;
  };
  /// One topic: reads on arrival.
  template <class Message, std::size_t kCapacity>
  class Tap {
   public:
    Tap(dds::Participant& participant, const std::atomic<std::uint64_t>& master);
    [[nodiscard]] bool pop(Arrived<Message>& arrived) { return ring_.try_pop(arrived); }
    /// Writer of somebody else that was dropped here; false: none since the last call.
    [[nodiscard]] bool pop_foreign(std::uint64_t& source) { return foreign_.try_pop(source); }
    [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(); }
    [[nodiscard]] const dds::Reader<Message>& reader() const noexcept { return reader_; }

   private:
    void on_data(dds::Reader<Message>& reader) noexcept;

    const std::atomic<std::uint64_t>& master_;
    dds::Senders senders_;
    SpscRing<Arrived<Message>, kCapacity> ring_;
    SpscRing<std::uint64_t, 64> foreign_;
    std::atomic<std::uint64_t> dropped_{0};
    dds::Reader<Message> reader_;  ///< last: it calls what uses the others
  };

  void note_master(const Receiver& receiver) noexcept;
  void look_for_bridges();
  void look_for_master(std::int64_t now_ns);
  void report_foreign(std::int64_t now_ns);
  void report_command(std::uint64_t source, std::int64_t now_ns);
  void report_source(const char* what, std::int32_t reader, std::uint64_t source);

  const dds::Participant& participant_;
  const Report& report_;
  std::atomic<std::uint64_t> master_{0};      ///< participant that is obeyed; 0: everybody passes
  std::atomic<std::uint64_t> service_id_{0};  ///< of the master
  std::atomic<std::uint64_t> master_source_{0};  ///< its writer of drive_command
  std::atomic<std::uint64_t> gone_source_{0};    ///< the same where DDS knows it no more
  SpscRing<Bridge, 64> bridges_;
  SpscRing<std::uint64_t, 64> refused_;  ///< writers of commands that the receiver dropped
  Tap<dds::DriveCommand, 512> commands_;
  Tap<dds::SetpointSample, 1024> setpoints_;
  dds::Reader<dds::MachineInfo> machines_;
  dds::Senders senders_;  ///< of `machines_`
  std::uint64_t checked_source_ = 0;
  std::int64_t checked_ns_ = 0;
  ForeignSources foreign_commands_, foreign_setpoints_;
};

}  // namespace meridian::drive
