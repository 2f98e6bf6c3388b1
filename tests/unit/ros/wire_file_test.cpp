// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/wire_file.hpp"

#include <gtest/gtest.h>

#include <map>

#include "support/machines.hpp"
#include "support/mcap_reading.hpp"
#include "support/text_file.hpp"

namespace meridian::ros {
namespace {

using test::CdrParts;
using test::TextFile;

class Wire : public testing::Test {
 protected:
  void open(const MachineModel& model) {
    model_ = model;
    auto file = WireFile::create(out_.path(), model_);
    ASSERT_TRUE(file.has_value());
    file_ = std::move(*file);
  }
  [[nodiscard]] record::WireRow row_at(std::uint64_t cycle) const {
    record::WireRow row;
    row.setpoint.cycle = cycle;
    row.setpoint.due_ns = static_cast<std::int64_t>(cycle) * model_.cycle_ns;
    row.setpoint.flags = kSetpointEnabled;
    row.setpoint.position = drives_of(model_, joints_);
    row.arrival_ns = row.setpoint.due_ns + 300'000;
    row.feedback_ns = row.setpoint.due_ns - 100'000;
    row.feedback_cycle = cycle - 1;
    row.feedback = row.setpoint.position;
    return row;
  }
  [[nodiscard]] test::McapContent content() const {
    return test::read_mcap(test::read_text(out_.path()));
  }
  /// What the messages of /events say.
  [[nodiscard]] std::vector<std::string> events() const {
    std::vector<std::string> out;
    for (const auto& message : content().messages) {
      if (message.topic != "/events") continue;
      CdrParts parts(message.data);
      (void)parts.number<std::uint64_t>();
      (void)parts.number<std::uint8_t>();
      const std::string source = parts.text();
      out.push_back(source + ": " + parts.text());
    }
    return out;
  }
  [[nodiscard]] std::size_t rows() const {
    std::size_t count = 0;
    for (const auto& message : content().messages) count += message.topic == "/cycle" ? 1U : 0U;
    return count;
  }

  TextFile out_{"", ".mcap"};
  MachineModel model_;
  JointVector joints_{};
  std::unique_ptr<WireFile> file_;
};

TEST_F(Wire, HandsOverEverySecondOfMotion) {
  open(test::lai_machine());
  for (std::uint64_t cycle = 5000; cycle < 7500; ++cycle) file_->add(row_at(cycle));
  EXPECT_EQ(rows(), 2001U) << "what a process that is killed now has written";
  EXPECT_FALSE(content().has_end);
  EXPECT_FALSE(file_->close());
  EXPECT_EQ(rows(), 2500U);
  EXPECT_TRUE(content().has_end && content().is_sound);
}

TEST_F(Wire, PutsTheJointsOfAStageWhereItsDrivesAre) {
  const MachineModel model = test::hybrid_machine();
  for (int i = 0; i < model.joint_count; ++i) joints_[i] = model.joints[i].home;
  open(model);
  file_->add(row_at(1));
  EXPECT_FALSE(file_->close());
  const LimitedVector wanted = limited_of(model, joints_);
  for (const auto& message : content().messages) {
    if (message.topic != "/cycle") continue;
    CdrParts parts(message.data);
    (void)parts.number<std::uint64_t>();
    (void)parts.text();
    (void)parts.number<std::uint64_t>();
    for (int i = 0; i < limited_count(model); ++i) {
      const double scale = limited_spec(model, i).is_rotary ? 1 : 1e-3;
      EXPECT_NEAR(parts.number<double>(), wanted[i] * scale, 2e-9) << limited_spec(model, i).name;
    }
  }
}

TEST_F(Wire, TellsStatesAlarmsAndDrives) {
  open(test::lai_machine());
  record::WireRow row = row_at(1);
  file_->add(row);
  file_->add_status(State::kRunning, Alarm::kNone, 0);
  file_->add_status(State::kRunning, Alarm::kNone, 0);
  row = row_at(2);
  row.statusword[1] = 0x0008;
  row.is_emergency_stop = true;
  file_->add(row);
  file_->add_status(State::kFaultStop, Alarm::kDriveFault, 1);
  file_->add_status(State::kFault, Alarm::kDriveFault, 1);
  EXPECT_FALSE(file_->close());
  const std::string name = model_.joints[1].name;
  EXPECT_EQ(events(), (std::vector<std::string>{"state: running", "drives: emergency stop",
                                                "drives: " + name + " fault", "state: fault_stop",
                                                "alarm: drive_fault of " + name, "state: fault"}));
}

TEST_F(Wire, TakesNoRowOutOfADamagedSetpoint) {
  open(test::lai_machine());
  file_->add(row_at(1));
  record::WireRow row = row_at(2);
  row.is_intact = false;
  file_->add(row);
  row.is_intact = true;
  row.setpoint.due_ns = -1;
  file_->add(row);
  file_->add(row_at(3));
  EXPECT_FALSE(file_->close());
  EXPECT_EQ(rows(), 2U);
  EXPECT_EQ(events(),
            (std::vector<std::string>{"cycle: a setpoint of another service, or corrupted",
                                      "cycle: a setpoint of another service, or corrupted",
                                      "cycle: 1 cycles missing"}));
}

TEST_F(Wire, SaysWhyAFileCannotBeMade) {
  const MachineModel model = test::lai_machine();
  const auto file = WireFile::create("/nowhere/x.mcap", model);
  ASSERT_FALSE(file.has_value());
  EXPECT_NE(file.error().text().find("/nowhere/x.mcap: cannot be created"), std::string::npos);
}

}  // namespace
}  // namespace meridian::ros
