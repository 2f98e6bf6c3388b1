// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/simulated_drives.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "service/transport/convert/messages.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/writer.hpp"
#include "support/machines.hpp"
#include "support/private_domain.hpp"

namespace meridian::drives {
namespace {

/// Drives on the wire, and two services that send them setpoints.
class OnTheWire : public testing::Test {
 protected:
  ~OnTheWire() override {
    is_stopping_ = true;
    thread_.join();
  }
  /// One period: the service whose controlwords come speaks first, the other one, which has counted
  /// cycles for an hour, behind it.
  void period() {
    if (++n_ % 50 == 1) {
      for (std::uint8_t drive = 0; drive < 5; ++drive) {
        dds::DriveCommand command;
        command.drive = drive;
        command.controlword = controlword_;
        command.service_id = 7;
        (void)commands_.write(command);
      }
    }
    dds::SetpointSample sample;
    sample.setpoint.cycle = 100 + n_;
    sample.setpoint.due_ns = std::chrono::steady_clock::now().time_since_epoch().count();
    sample.crc = dds::setpoint_crc(sample.setpoint, 7);
    (void)setpoints_.write(sample);
    sample.setpoint.cycle = kOthers + n_;
    sample.crc = dds::setpoint_crc(sample.setpoint, 7);  // it may quote the id: everybody knows it
    (void)others_.write(sample);
    for (int n = 0; n < flood_; ++n) {
      ++sample.setpoint.cycle;
      (void)others_.write(sample);
      (void)other_commands_.write({.controlword = 0x06, .service_id = 7});
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  static constexpr std::uint64_t kOthers = 3'600'000;
  const MachineModel model_ = test::lai_machine();
  const support::PrivateDomain domain_;
  const dds::ParticipantOptions options_{.domain = domain_.id(), .machine = model_.name};
  dds::Participant drives_{options_}, obeyed_{options_}, other_{options_};
  dds::Writer<dds::DriveCommand> commands_{obeyed_}, other_commands_{other_};
  dds::Writer<dds::SetpointSample> setpoints_{obeyed_}, others_{other_};
  dds::Reader<dds::DriveFeedback> feedback_{obeyed_};
  std::uint64_t n_ = 0;
  std::uint16_t controlword_ = 0x06;
  int flood_ = 0;  ///< samples of the other one in a period
  std::atomic<bool> is_stopping_{false};
  std::vector<std::string> said_;  ///< to be read when the thread has ended
  SimulatedDrivesReport report_;
  std::thread thread_{[this] {
    SimulatedDrivesOptions options;
    options.is_action_peer = false;
    report_ = run_simulated_drives(drives_, model_, options, is_stopping_,
                                   [this](const std::string& text) { said_.push_back(text); });
  }};
};

TEST_F(OnTheWire, DrivesTakeTheSetpointsOfTheServiceWhoseControlwordsTheyObey) {
  dds::DriveFeedback feedback;
  const auto is_obeyed = [&] {
    return feedback_.take(feedback) && feedback.cycle_seen > 100 && feedback.cycle_seen < kOthers;
  };
  while (n_ < 5000 && !is_obeyed()) period();
  ASSERT_LT(n_, 5000U) << "nobody was obeyed";
  std::uint64_t newest = 0;
  for (int n = 0; n < 400; ++n) {
    period();
    while (feedback_.take(feedback)) newest = feedback.cycle_seen;
    ASSERT_LT(newest, kOthers);
  }
  EXPECT_GT(newest, 300U) << "they are not hidden behind the other one's either";
  is_stopping_ = true;
  thread_.join();
  thread_ = std::thread([] {});
  EXPECT_GT(report_.dropped[drive::Drop::kForeignSetpoint], 0U);
  int reported = 0;
  for (const std::string& text : said_)
    reported += text.find("are dropped: the drives obey") != std::string::npos;
  EXPECT_EQ(reported, 1);
}

TEST_F(OnTheWire, AFloodOfAnotherOneHidesNothingOfTheMaster) {
  dds::DriveFeedback feedback;
  const auto is_obeyed = [&] { return feedback_.take(feedback) && feedback.cycle_seen > 100; };
  while (n_ < 5000 && !is_obeyed()) period();
  ASSERT_LT(n_, 5000U) << "nobody was obeyed";
  EXPECT_EQ(feedback.service_id, 7U);
  flood_ = 20;  // more than wait in a reader
  controlword_ = 0x07;
  const auto is_switched_on = [&] {
    while (feedback_.take(feedback)) continue;
    return drive_state(feedback.statusword[0]) == DriveState::kSwitchedOn;
  };
  const std::uint64_t begin = n_;
  while (n_ < begin + 500 && !is_switched_on()) period();
  EXPECT_LT(n_, begin + 500) << "the word that was written once in 50 periods was hidden";
  const std::uint64_t seen = feedback.cycle_seen;
  for (int n = 0; n < 200; ++n) {
    period();
    while (feedback_.take(feedback)) continue;
    ASSERT_LT(feedback.cycle_seen, kOthers);
    ASSERT_EQ(drive_state(feedback.statusword[0]), DriveState::kSwitchedOn);
  }
  // How far behind they are is the host's: the flood is more than a busy one takes in.
  EXPECT_GT(feedback.cycle_seen, seen + 20) << "its setpoints were hidden";
}

}  // namespace
}  // namespace meridian::drives
