// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/bridge/ros_bridge.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <sstream>
#include <thread>

#include "service/host/process/child_process.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/writer.hpp"
#include "support/private_domain.hpp"
#include "support/shipped_machines.hpp"

namespace meridian::bridge {
namespace {

using std::chrono::milliseconds, std::chrono::seconds;

constexpr int kStates = 500;
constexpr const char* kReader = MERIDIAN_BINARY_DIR "/bin/fast_reader";

[[nodiscard]] BridgeTime time_of(int step) {
  const std::int64_t ns = step * std::int64_t{4'000'000};
  return {ns, 1'700'000'000'000'000'000 + ns};
}

/// A service and its drives as a viewer sees them, the bridge, and a reader of Fast DDS.
class RosBridgeOnTheWire : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kReader)) {
      GTEST_SKIP() << "Fast DDS (package libfastrtps-dev) was not there at the build";
    }
    reader_.emplace(
        std::vector<std::string>{kReader, std::to_string(domain_.id()), std::to_string(kStates)});
    // What the bridge keeps for late readers may come before the word that the reader stands.
    std::optional<std::string> line = reader_->read_line(seconds(20));
    for (; line && *line != "ready"; line = reader_->read_line(seconds(20)))
      early_.push_back(*line);
    ASSERT_TRUE(line) << "the reader of Fast DDS did not start";
  }
  [[nodiscard]] JointVector position_of(int step) const {
    JointVector out{};
    for (int i = 0; i < model_.joint_count; ++i) {
      out[static_cast<std::size_t>(i)] = 0.001 * step + 0.1 * i;
    }
    return out;
  }
  /// One report of the drives and one step of the bridge behind it.
  void step(int n) {
    feedback_.sample = static_cast<std::uint64_t>(n);
    feedback_.position = position_of(n);
    ASSERT_TRUE(feedbacks_.write(feedback_));
    bridge_.work(time_of(n));
  }
  [[nodiscard]] std::vector<std::string> lines_to_the_end() {
    std::vector<std::string> lines = early_;
    while (const auto line = reader_->read_line(seconds(40))) {
      lines.push_back(*line);
      if (line->rfind("end ", 0) == 0) break;
    }
    return lines;
  }

  support::PrivateDomain domain_;
  MachineModel model_ = config::load_machine(test::shipped_file("lai").string());
  dds::Participant service_{{.domain = domain_.id(), .machine = "lai"}};
  dds::Participant viewer_{{.domain = domain_.id(), .machine = "lai"}};
  dds::Participant ros_{{.domain = domain_.id(), .machine = ""}};
  dds::Writer<dds::DriveFeedback> feedbacks_{service_};
  dds::DriveFeedback feedback_{.joint_mask = 0x3F};
  RosBridge bridge_{viewer_, ros_, model_, time_of(0)};
  std::optional<process::ChildProcess> reader_;
  std::vector<std::string> early_;
};

TEST_F(RosBridgeOnTheWire, FastDdsReadsEveryJointStateWithItsValues) {
  const auto patience = std::chrono::steady_clock::now() + seconds(20);
  while (bridge_.joint_state_readers() == 0 && std::chrono::steady_clock::now() < patience) {
    std::this_thread::sleep_for(milliseconds(20));
  }
  ASSERT_EQ(bridge_.joint_state_readers(), 1);
  std::this_thread::sleep_for(milliseconds(500));  // the reader has heard of the writer too
  for (int n = 1; n <= kStates; ++n) {
    step(n);
    std::this_thread::sleep_for(milliseconds(2));
  }
  const RosCounts counts = bridge_.counts();
  EXPECT_EQ(counts.joint_states, static_cast<std::uint64_t>(kStates));
  EXPECT_EQ(counts.refused, 0U);

  int state = 0, transforms = 0, statics = 0, descriptions = 0, diagnostics = 0;
  std::string end;
  for (const std::string& line : lines_to_the_end()) {
    std::istringstream in(line);
    std::string word;
    in >> word;
    if (word == "tf") ++transforms;
    if (word == "tf_static") {
      ++statics;
      EXPECT_EQ(line, "tf_static tool workpiece");
    }
    if (word == "robot_description") {
      ++descriptions;
      EXPECT_NE(line.find("<?xml version=\"1.0\"?>"), std::string::npos);
    }
    if (word == "diagnostics") {
      ++diagnostics;
      EXPECT_EQ(line, "diagnostics 1 3 meridian: program: the service says nothing");
    }
    if (word == "end") end = line;
    if (word != "joint_state") continue;
    ++state;
    std::int64_t stamp = 0;
    in >> stamp;
    EXPECT_EQ(stamp, time_of(state).system_ns);
    const JointVector wanted = position_of(state);
    for (int i = 0; i < model_.joint_count; ++i) {
      const JointSpec& spec = model_.joints[static_cast<std::size_t>(i)];
      std::string name;
      double position = 0, velocity = 0;
      in >> name >> position >> velocity;
      EXPECT_EQ(name, spec.name);
      const double in_ros = wanted[static_cast<std::size_t>(i)] * (spec.is_rotary ? 1 : 1e-3);
      EXPECT_NEAR(position, in_ros, 1e-9) << "2^-30 m or rad";
    }
  }
  EXPECT_EQ(end, "end " + std::to_string(kStates));
  EXPECT_EQ(state, kStates);
  EXPECT_EQ(transforms, kStates);
  EXPECT_EQ(statics, 1) << "for who comes late";
  EXPECT_EQ(descriptions, 1);
  EXPECT_GE(diagnostics, 1);
}

}  // namespace
}  // namespace meridian::bridge
