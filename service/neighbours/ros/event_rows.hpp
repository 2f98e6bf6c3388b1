// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/machine_model.hpp"
#include "service/neighbours/ros/message_types.hpp"
#include "service/neighbours/ros/topics/event_topic.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::ros {

/// The events that rows tell by being other than the row before: states, alarms, programs, drives,
/// cycles that are missing. Proof: tests/unit/ros/event_test.cpp.
class EventRows {
 public:
  EventRows(EventTopic& topic, const MachineModel& model, const Contents& contents)
      : topic_(topic), model_(model), contents_(contents) {}
  void write(const record::RecordingRow& row);

 private:
  void write_cycle(const record::RecordingRow& row);
  void write_machine(const record::RecordingRow& row);
  void write_drives(const record::RecordingRow& row);

  EventTopic& topic_;
  const MachineModel& model_;
  Contents contents_;
  record::RecordingRow last_;
  bool has_row_ = false;
};

}  // namespace meridian::ros
