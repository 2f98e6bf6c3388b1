// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/bridge/ros_bridge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <sstream>
#include <thread>

#include "service/host/process/child_process.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/scene/link_frames.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/writer.hpp"
#include "support/private_domain.hpp"
#include "support/shipped_machines.hpp"

namespace meridian::bridge {
namespace {

using std::chrono::milliseconds, std::chrono::seconds;

constexpr int kStates = 500, kLastSetpoint = 300;
constexpr std::uint64_t kService = 7;
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
  void wait_for_reader() const {
    const auto patience = std::chrono::steady_clock::now() + seconds(20);
    while (bridge_.joint_state_readers() == 0 && std::chrono::steady_clock::now() < patience) {
      std::this_thread::sleep_for(milliseconds(20));
    }
    ASSERT_EQ(bridge_.joint_state_readers(), 1);
    std::this_thread::sleep_for(milliseconds(500));  // the reader has heard of the writer too
  }
  void step_to_the_end() {
    for (int n = 1; n <= kStates; ++n) {
      step(n);
      std::this_thread::sleep_for(milliseconds(2));
    }
  }
  [[nodiscard]] JointVector position_of(int step) const {
    JointVector out{};
    for (int i = 0; i < model_.joint_count; ++i) {
      out[static_cast<std::size_t>(i)] = 0.001 * step + 0.1 * i;
    }
    return out;
  }
  [[nodiscard]] JointVector velocity_of(int step) const {
    JointVector out{};
    for (int i = 0; i < model_.joint_count; ++i) {
      out[static_cast<std::size_t>(i)] = 0.01 * step - 0.2 * i;
    }
    return out;
  }
  /// A setpoint of `service_id`, as its checksum says.
  void send(int n, std::uint64_t service_id) {
    dds::SetpointSample sample;
    sample.setpoint.cycle = static_cast<std::uint64_t>(n);
    sample.setpoint.flags = kSetpointEnabled;
    sample.setpoint.position = position_of(n);
    sample.setpoint.velocity = velocity_of(n);
    sample.crc = dds::setpoint_crc(sample.setpoint, service_id);
    ASSERT_TRUE(setpoints_.write(sample));
  }
  /// One report of the drives and one step of the bridge behind it. The service dies behind
  /// kLastSetpoint; another one that the drives do not obey goes on.
  void step(int n) {
    feedback_.sample = static_cast<std::uint64_t>(n);
    feedback_.position = position_of(n);
    ASSERT_TRUE(feedbacks_.write(feedback_));
    if (n <= kLastSetpoint) send(n, kService);
    send(n + 1000, kService + 1);
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

  void expect_state(std::istream& in, int n) const {
    std::int64_t stamp = 0;
    std::size_t velocities = 0;
    in >> stamp >> velocities;
    EXPECT_EQ(stamp, time_of(n).system_ns);
    // A velocity is 0.1 s old at most: 25 steps.
    const bool is_fresh = n <= kLastSetpoint + 25;
    EXPECT_EQ(velocities, is_fresh ? static_cast<std::size_t>(model_.joint_count) : 0U) << n;
    const auto unit = [&](int i) {
      return model_.joints[static_cast<std::size_t>(i)].is_rotary ? 1 : 1e-3;
    };
    for (int i = 0; i < model_.joint_count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      std::string name;
      double position = 0;
      in >> name >> position;
      EXPECT_EQ(name, model_.joints[at].name);
      EXPECT_NEAR(position, position_of(n)[at] * unit(i), 1e-9) << "2^-30 m or rad";
    }
    const JointVector sent = velocity_of(std::min(n, kLastSetpoint));
    for (int i = 0; is_fresh && i < model_.joint_count; ++i) {
      double velocity = 0;
      in >> velocity;
      EXPECT_NEAR(velocity, sent[static_cast<std::size_t>(i)] * unit(i), 1e-6) << "2^-20 m/s";
    }
  }
  enum class Frames : std::uint8_t { kMoving, kFixed };
  /// The frames that the machine's kinematics have with the joints at `q`, and no other.
  void expect_frames(std::istream& in, const JointVector& q, Frames which) {
    for (const scene::LinkFrame& frame : frames_.at(q, model_.tool_length_mm)) {
      const bool is_fixed = frame.name == "tool" || frame.name == "workpiece";
      if (is_fixed != (which == Frames::kFixed)) continue;
      std::string parent, name;
      in >> parent >> name;
      EXPECT_EQ(parent, frame.parent);
      EXPECT_EQ(name, frame.name);
      const Eigen::Vector3d translation = 1e-3 * frame.pose.translation();
      const Eigen::Vector4d rotation = Eigen::Quaterniond(frame.pose.linear()).coeffs();
      double number = 0;
      for (int i = 0; i < 7; ++i) {
        in >> number;
        EXPECT_NEAR(number, i < 3 ? translation[i] : rotation[i - 3], 1e-6)
            << "2^-20 m or of a unit quaternion: " << name << ", " << i;
      }
    }
    std::string more;
    EXPECT_FALSE(in >> more) << more;
  }

  support::PrivateDomain domain_;
  MachineModel model_ = config::load_machine(test::shipped_file("lai").string());
  scene::LinkFrames frames_{model_};
  dds::Participant service_{{.domain = domain_.id(), .machine = "lai"}};
  dds::Participant viewer_{{.domain = domain_.id(), .machine = "lai"}};
  dds::Participant ros_{{.domain = domain_.id(), .machine = ""}};
  dds::Writer<dds::DriveFeedback> feedbacks_{service_};
  dds::Writer<dds::SetpointSample> setpoints_{service_};
  dds::DriveFeedback feedback_{.joint_mask = 0x3F, .service_id = kService};
  RosBridge bridge_{viewer_, ros_, model_, time_of(0)};
  std::optional<process::ChildProcess> reader_;
  std::vector<std::string> early_;
};

TEST_F(RosBridgeOnTheWire, FastDdsReadsEveryJointStateAndFrameWithItsNumbers) {
  wait_for_reader();
  step_to_the_end();
  const RosCounts counts = bridge_.counts();
  EXPECT_EQ(counts.joint_states, static_cast<std::uint64_t>(kStates));
  EXPECT_EQ(counts.refused, 0U);

  int state = 0, moving = 0, statics = 0, descriptions = 0, diagnostics = 0;
  std::string end;
  for (const std::string& line : lines_to_the_end()) {
    std::istringstream in(line);
    std::string word;
    in >> word;
    if (word == "tf") {
      ++moving;
      expect_frames(in, position_of(moving), Frames::kMoving);
    }
    if (word == "tf_static") {
      ++statics;
      expect_frames(in, JointVector{}, Frames::kFixed);
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
    expect_state(in, state);
  }
  EXPECT_EQ(end, "end " + std::to_string(kStates));
  EXPECT_EQ(state, kStates);
  EXPECT_EQ(moving, kStates);
  EXPECT_EQ(statics, 1) << "for who comes late";
  EXPECT_EQ(descriptions, 1);
  EXPECT_GE(diagnostics, 1);
}

TEST_F(RosBridgeOnTheWire, TheToolFrameIsAtTheTipOfTheToolInTheSpindle) {
  dds::Writer<dds::Status> statuses(service_);
  wait_for_reader();
  dds::Status status;
  status.service_id = kService;
  model_.tool_length_mm += 40;
  status.tool_length_mm = model_.tool_length_mm;
  ASSERT_TRUE(statuses.write(status));
  step_to_the_end();
  std::string newest;
  for (const std::string& line : lines_to_the_end()) {
    if (line.rfind("tf_static ", 0) == 0) newest = line;
  }
  std::istringstream in(newest.substr(newest.find(' ') + 1));
  expect_frames(in, JointVector{}, Frames::kFixed);
}

}  // namespace
}  // namespace meridian::bridge
