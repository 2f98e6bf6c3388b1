// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <thread>

#include "meridian/cycle/drive_state.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/writer.hpp"

namespace meridian::test {

/// A service for drives on the wire, as far as drives see one: controlwords, setpoints and actions.
class WireService {
 public:
  explicit WireService(const dds::ParticipantOptions& options, std::uint64_t service_id = 7)
      : participant_(options), id_(service_id) {}

  /// One period: says `controlword` now and then, and sends a setpoint.
  void period(std::uint16_t controlword, double x, std::uint16_t flags) {
    if (++n_ % 20 == 1 || controlword != said_) {
      said_ = controlword;
      for (std::uint8_t drive = 0; drive < 5; ++drive) {
        (void)commands_.write({.drive = drive, .controlword = controlword, .service_id = id_});
      }
    }
    dds::SetpointSample sample;
    sample.setpoint.cycle = 100 + n_;
    sample.setpoint.due_ns = std::chrono::steady_clock::now().time_since_epoch().count();
    sample.setpoint.position[0] = x;
    sample.setpoint.flags = flags;
    sample.crc = dds::setpoint_crc(sample.setpoint, id_);
    (void)setpoints_.write(sample);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    while (feedbacks_.take(feedback)) ++reports;
  }
  /// Walks up to operation enabled; false: nobody did in so many periods.
  [[nodiscard]] bool enable(int periods = 8000) {
    constexpr std::array<std::uint16_t, 3> kWords{0x06, 0x07, 0x0F};
    std::size_t step = 0;
    for (int n = 0; n < periods; ++n) {
      const DriveState state = drive_state(feedback.statusword[0]);
      if (state == DriveState::kReadyToSwitchOn) step = 1;
      if (state == DriveState::kSwitchedOn) step = 2;
      if (state == DriveState::kOperationEnabled) return true;
      period(kWords[step], 0, 0);
    }
    return false;
  }

  dds::DriveFeedback feedback;
  std::uint64_t reports = 0;

 private:
  dds::Participant participant_;
  std::uint64_t id_, n_ = 0;
  std::uint16_t said_ = 0;
  dds::Writer<dds::DriveCommand> commands_{participant_};
  dds::Writer<dds::SetpointSample> setpoints_{participant_};
  dds::Reader<dds::DriveFeedback> feedbacks_{participant_};

 public:
  dds::Writer<dds::Action> actions{participant_};
  dds::Reader<dds::ActionDone> actions_done{participant_};
};

}  // namespace meridian::test
