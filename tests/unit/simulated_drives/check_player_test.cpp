// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/check/check_player.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "support/machines.hpp"

namespace meridian::drives {
namespace {

enum class Said : std::uint8_t { kClaim, kCommand, kSetpoint };

/// What is said, period by period.
class Listener : public CheckedDrives {
 public:
  void say(Speaker, const dds::MachineInfo& machine) override {
    said.push_back(Said::kClaim);
    service_id = machine.service_id;
    bridge_cycles = machine.bridge_cycles;
  }
  void say(Speaker, const dds::DriveCommand&) override { said.push_back(Said::kCommand); }
  void say(Speaker, const dds::SetpointSample&) override { said.push_back(Said::kSetpoint); }
  void end(Speaker) override {}
  void begin(Speaker) override {}
  void ask(Wish) override {}
  [[nodiscard]] bool period(std::vector<dds::DriveFeedback>&) override {
    said.clear();
    return true;
  }
  [[nodiscard]] std::int64_t now_ns() const override { return 0; }

  std::vector<Said> said;
  std::uint64_t service_id = 0;
  int bridge_cycles = 0;
};

class Player : public testing::Test {
 protected:
  /// What is said in the next period.
  std::vector<Said> next() {
    std::vector<Said> said;
    player_.tick([&](CheckedDrives&) { said = drives_.said; });
    return said;
  }
  const MachineModel model_ = test::lai_machine();
  Listener drives_;
  CheckPlayer player_{model_, drives_};
};

/// Until drives hear it they bridge as their machine file says: the check would find that as a
/// fault.
TEST_F(Player, SaysFirstForHowLongDrivesAreToBridgeWheneverItBeginsToSpeak) {
  for (const int silence : {1, 123, 499, 777}) {
    player_.saying = Saying::kNothing;
    for (int n = 0; n < silence; ++n) EXPECT_TRUE(next().empty());
    player_.saying = Saying::kAll;
    const std::vector<Said> said = next();
    ASSERT_FALSE(said.empty()) << silence;
    EXPECT_EQ(said.front(), Said::kClaim) << silence;
    EXPECT_EQ(drives_.bridge_cycles, CheckPlayer::kBridge);
    player_.ticks(7);
  }
}

TEST_F(Player, ARestartedServiceSaysAtOnceWhoItIsAndCommandsEveryDrive) {
  player_.ticks(7);
  player_.end_service();
  player_.restart_service();
  const std::vector<Said> said = next();
  EXPECT_EQ(said.size(), 1U + static_cast<std::size_t>(model_.joint_count) + 1U);
  EXPECT_EQ(said.front(), Said::kClaim);
  EXPECT_EQ(drives_.service_id, CheckPlayer::kRestartedId);
}

}  // namespace
}  // namespace meridian::drives
