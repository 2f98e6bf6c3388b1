// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/neighbours/ros/derived_row.hpp"
#include "service/neighbours/ros/event_rows.hpp"
#include "service/neighbours/ros/topics/cycle_topic.hpp"
#include "service/neighbours/ros/topics/drives_topic.hpp"
#include "service/neighbours/ros/topics/event_topic.hpp"
#include "service/neighbours/ros/topics/joint_topic.hpp"
#include "service/neighbours/ros/topics/limit_topic.hpp"
#include "service/neighbours/ros/topics/marker_topic.hpp"
#include "service/neighbours/ros/topics/tip_topic.hpp"
#include "service/neighbours/ros/topics/transform_topic.hpp"
#include "service/recording/record/file/record_error.hpp"

namespace meridian::ros {

/// A recording as an MCAP file: rows come in, the messages of every topic go out
/// (docs/recordings.md). Memory does not grow with the rows but for the index of the chunks, 100
/// bytes a second of motion. Units: mm, rad, s in the rows; m, rad, s in the file.
/// Context: I/O; one thread. Proof: tests/unit/ros/motion_file_test.cpp.
class MotionFile {
 public:
  /// Creates or empties the file. `model` must live on.
  [[nodiscard]] static Expected<std::unique_ptr<MotionFile>, record::RecordError> create(
      const std::string& path, const MachineModel& model, const Contents& contents,
      const std::string& origin);

  /// Whether the times of MCAP and ROS can say the row's.
  [[nodiscard]] static bool has_time(std::int64_t due_ns) noexcept;
  /// Adds the messages of a row that has_time(). False once a write failed; they are dropped then.
  bool write(const record::RecordingRow& row);
  /// Adds what rows do not tell.
  void write_event(std::int64_t time_ns, Level level, const std::string& source,
                   const std::string& text);
  /// Hands what waits to the system: what is lost where the process is killed.
  bool end_chunk() { return writer_->end_chunk(); }
  /// Ends the file; the error where anything was lost.
  [[nodiscard]] std::optional<record::RecordError> close();

  [[nodiscard]] std::uint64_t rows() const noexcept { return rows_; }
  [[nodiscard]] std::uint64_t events() const noexcept { return events_.count(); }
  [[nodiscard]] std::uint64_t bytes() const noexcept { return writer_->size(); }

 private:
  MotionFile(const std::string& path, std::unique_ptr<mcap::Writer> writer,
             const MachineModel& model, const Contents& contents);

  std::string path_;
  std::unique_ptr<mcap::Writer> writer_;
  DerivedRow derived_;
  JointTopic joints_;
  TipTopic tip_;
  CycleTopic cycles_;
  LimitTopic limits_;
  TransformTopic transforms_;
  MarkerTopic markers_;
  EventTopic events_;
  EventRows event_rows_;
  std::optional<DrivesTopic> drives_;
  std::uint64_t rows_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace meridian::ros
