// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/expected.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/recording/record/file/record_error.hpp"

namespace meridian::record {

/// One row of a recording. What the file has no column for keeps its default. Units: mm, rad, s.
struct RecordingRow {
  std::uint64_t cycle = 0;
  std::int64_t due_ns = 0;
  std::uint32_t line = 0;
  std::uint16_t epoch = 0;
  std::uint16_t flags = kSetpointEnabled;
  MotionKind kind = MotionKind::kCut;
  State state = State::kRunning;
  std::int32_t lateness_ns = 0;
  std::int32_t computation_ns = 0;
  std::uint64_t sequence = 0;
  double plan_time_s = 0;
  double rate = 1;
  JointVector joints{};
  /// Joints, then the drives of the stage; of a recording without their columns as they must be.
  LimitedVector positions{};
  LimitedVector velocity{};

  /// What drives reported: of the flight recorder and, in part, of `meridian record`. Drive
  /// coordinates in drive order.
  JointVector feedback{};
  std::uint64_t feedback_cycle = 0;  ///< newest setpoint that the drives had taken
  std::int64_t feedback_age_ns = -1;
  std::array<std::uint16_t, kMaxJoints> statusword{}, drive_error{};
  bool is_emergency_stop = false;
  Alarm alarm = Alarm::kNone;
  int alarm_joint = -1;  ///< place in limited.hpp; -1: none
};

/// Reads a recording row by row, as often as wanted, in constant memory (the file is mapped).
///
/// Needs the columns cycle, due_ns and one `<joint>_mm` or `<joint>_rad` per joint of the machine,
/// in any order; the other columns of RecordingWriter are taken where they are, unknown ones are
/// skipped. Of a machine with a stage the columns of its drives do instead of those of the joints
/// that they carry, as in a recording of the wire. Every number is checked. Not thread-safe.
/// Proof: tests/unit/record/recording_test.cpp.
class RecordingReader {
 public:
  [[nodiscard]] static Expected<RecordingReader, RecordError> open(const std::string& path,
                                                                   const MachineModel& model);
  ~RecordingReader();
  RecordingReader(const RecordingReader&) = delete;
  RecordingReader& operator=(const RecordingReader&) = delete;
  RecordingReader(RecordingReader&&) noexcept;
  RecordingReader& operator=(RecordingReader&&) noexcept;

  /// Reads the next row into `row`; false after the last one.
  [[nodiscard]] Expected<bool, RecordError> next(RecordingRow& row);
  /// Back to the first row.
  void rewind() noexcept;

  [[nodiscard]] bool has_velocity() const noexcept;
  [[nodiscard]] bool has_plan_time() const noexcept;
  /// Whether there is what the cycle says of itself: state, kind, block, rate.
  [[nodiscard]] bool has_state() const noexcept;
  /// Whether there are alarms.
  [[nodiscard]] bool has_alarm() const noexcept;
  /// Whether there is what every drive says of itself.
  [[nodiscard]] bool has_statuswords() const noexcept;
  /// Whether there is the feedback of every drive, with the setpoint that it had seen.
  [[nodiscard]] bool has_feedback() const noexcept;
  [[nodiscard]] const std::string& path() const noexcept;

 private:
  class Impl;
  explicit RecordingReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace meridian::record
