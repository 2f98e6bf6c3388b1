// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/machine_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "service/machine/file/machine_file.hpp"
#include "service/text/whole_file.hpp"
#include "service/transport/writer.hpp"
#include "support/private_domain.hpp"

namespace meridian::panel {
namespace {

using nlohmann::json;

/// A service as far as a panel hears it, and what the panel shows of it.
class WatchedService : public testing::Test {
 protected:
  static constexpr std::uint64_t kService = 7;

  void SetUp() override {
    until([this] { return setpoints_.matched_readers() > 0 && statuses_.matched_readers() > 0; });
    info_.service_id = kService;
    info_.is_serving = true;
    info_.name = model_.name;
    info_.cycle_ns = model_.cycle_ns;
    info_.machine_file = text::read_whole(kFile).value();
    info_.tool_length_mm = model_.tool_length_mm;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        info_.frame_rotation.at(static_cast<std::size_t>(3 * row + column)) =
            model_.X_MW.rotation(row, column);
      }
      info_.frame_origin_mm.at(static_cast<std::size_t>(row)) = model_.X_MW.origin_mm[row];
    }
    status_.service_id = kService;
    status_.state = State::kReady;
    status_.tool_length_mm = model_.tool_length_mm;
  }

  void publish_machine() {
    ASSERT_TRUE(machines_.write(info_));
    until([this] {
      watch_.poll();
      return hub_.newest(Hub::kMachine) != nullptr;
    });
  }
  /// Joint X at `x` mm in the next cycle.
  void send_setpoint(double x) {
    dds::SetpointSample sample;
    sample.setpoint.cycle = ++cycle_;
    sample.setpoint.position[0] = x;
    sample.setpoint.flags = kSetpointEnabled;
    sample.crc = dds::setpoint_crc(sample.setpoint, kService);
    ASSERT_TRUE(setpoints_.write(sample));
  }
  /// The frame that the panel makes of the next status.
  [[nodiscard]] json next_frame() {
    status_.status_sequence += 1;
    status_.cycle = cycle_;
    json frame;
    until([&] {
      EXPECT_TRUE(statuses_.write(status_));
      watch_.poll();
      const Hub::Text text = hub_.newest(Hub::kFrame);
      if (text) frame = json::parse(*text);
      return text && frame.value("sequence", 0U) == status_.status_sequence;
    });
    return frame;
  }

  template <class IsTrue>
  static void until(IsTrue is_true) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!is_true()) {
      ASSERT_LT(std::chrono::steady_clock::now(), end) << "time is up";
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  const std::filesystem::path kFile = MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml";
  const MachineModel model_ = config::load_machine(kFile);
  const support::PrivateDomain domain_;
  dds::Participant participant_{{.domain = domain_.id(), .machine = model_.name}};
  dds::Writer<dds::MachineInfo> machines_{participant_};
  dds::Writer<dds::Status> statuses_{participant_};
  dds::Writer<dds::SetpointSample> setpoints_{participant_};
  Hub hub_;
  MachineWatch watch_{participant_, hub_};
  dds::MachineInfo info_;
  dds::Status status_;
  std::uint64_t cycle_ = 0;
};

using MachineWatchTest = WatchedService;

/// Heights of the trail's points, mm.
[[nodiscard]] std::vector<double> heights(const json& frame) {
  std::vector<double> out;
  for (const json& point : frame.at("trail")) out.push_back(point.at(2));
  return out;
}

TEST_F(MachineWatchTest, DrawsEverySetpointWithTheToolOfItsOwnTime) {
  publish_machine();
  status_.tool_length_mm = model_.tool_length_mm + 40;
  static_cast<void>(next_frame());
  for (int i = 0; i < 8; ++i) send_setpoint(0);
  const auto longer = heights(next_frame());
  for (int i = 0; i < 8; ++i) send_setpoint(0);
  status_.tool_length_mm = model_.tool_length_mm;
  const auto changed = heights(next_frame());
  for (int i = 0; i < 8; ++i) send_setpoint(0);
  const auto shorter = heights(next_frame());
  ASSERT_EQ(longer.size(), 1U);
  ASSERT_EQ(changed.size(), 1U);
  ASSERT_EQ(shorter.size(), 1U);
  EXPECT_NEAR(changed[0] - longer[0], 40, 1e-6) << "its last point, in the rest of the change";
  EXPECT_NEAR(shorter[0] - longer[0], 40, 1e-6);
  EXPECT_NEAR(shorter[0], forward(model_, model_.tool_length_mm, JointVector{}).tip[2], 1e-6);
}

TEST_F(MachineWatchTest, AMachineFileThatIsTooLongLeavesStateAlarmAndVerbs) {
  info_.machine_file.clear();
  info_.joint_count = 1;
  info_.joints[0].name = "X";
  publish_machine();
  EXPECT_TRUE(json::parse(*hub_.newest(Hub::kMachine)).at("scene").is_null());
  status_.state = State::kFault;
  status_.alarm = Alarm::kFollowingError;
  status_.alarm_joint = 0;
  const json frame = next_frame();
  EXPECT_EQ(frame.at("state"), "Fault");
  EXPECT_NE(frame.at("alarm").at("text").get<std::string>().find("X"), std::string::npos);
  EXPECT_EQ(frame.at("can").at(0), "reset");
  EXPECT_FALSE(frame.contains("tip"));
}

}  // namespace
}  // namespace meridian::panel
