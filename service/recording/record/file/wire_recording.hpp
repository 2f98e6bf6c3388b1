// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/file/csv_file.hpp"
#include "service/recording/record/file/record_error.hpp"

/// What somebody on the wire saw of setpoints and feedback: `meridian record`. Units: mm, rad, s.
namespace meridian::record {

/// A setpoint as it arrived, with the newest feedback that had come by then.
struct WireRow {
  Setpoint setpoint;
  bool is_intact = true;             ///< its checksum fits it and the service that was followed
  std::int64_t arrival_ns = 0;       ///< clock of due_ns
  std::uint64_t feedback_cycle = 0;  ///< setpoint that the drives had taken; 0: no feedback yet
  JointVector feedback{};

  // What else the drives said by then, for which the file of a WireWriter has no columns.
  std::int64_t feedback_ns = 0;  ///< arrival of the newest feedback; 0: none yet
  std::array<std::uint16_t, kMaxJoints> statusword{}, drive_error{};
  bool is_emergency_stop = false;
};

/// Writes what was seen: a recording that `meridian check` reads. Columns: cycle, due_ns, line, the
/// joints, their velocities, epoch, flags, is_intact, arrival_minus_due_ns, feedback_cycle,
/// and `<joint>_feedback_mm` or `_rad`. The wire does not carry kind, state and plan time.
/// Proof: tests/unit/record/wire_recording_test.cpp.
class WireWriter {
 public:
  [[nodiscard]] static Expected<WireWriter, RecordError> create(const std::string& path,
                                                                const MachineModel& model);
  bool write(const WireRow& row) noexcept;
  bool close() noexcept { return file_.close(); }
  [[nodiscard]] int error_number() const noexcept { return file_.error_number(); }

 private:
  WireWriter(CsvFile file, int joint_count) : file_(std::move(file)), joint_count_(joint_count) {}
  CsvFile file_;
  int joint_count_;
};

/// Counts what arrived: gaps, order, ages, following error. Memory is fixed.
class WireBook {
 public:
  explicit WireBook(const MachineModel& model) : model_(model), cycle_ns_(model.cycle_ns) {}

  void add(const WireRow& row);

  [[nodiscard]] std::uint64_t received() const noexcept { return received_; }
  /// Cycles between the first and the last seen that never came.
  [[nodiscard]] std::uint64_t missing() const noexcept { return missing_; }
  [[nodiscard]] std::uint64_t restarts() const noexcept { return restarts_; }
  /// The book for a person.
  [[nodiscard]] std::string to_text() const;

 private:
  static constexpr std::size_t kRemembered = 1024;  ///< setpoints that feedback may refer to
  static constexpr std::size_t kMaxGaps = 20;       ///< that are reported one by one
  struct Gap {
    std::uint64_t after = 0, count = 0;
  };
  /// False for a sample that is not newer than the last.
  [[nodiscard]] bool check_order(const Setpoint& setpoint);
  void check_following(const WireRow& row);

  const MachineModel& model_;
  std::int64_t cycle_ns_;
  std::uint64_t received_ = 0, missing_ = 0, longest_gap_ = 0, duplicates_ = 0, restarts_ = 0;
  std::uint64_t gap_count_ = 0, off_grid_ = 0, dry_ = 0;
  std::uint64_t not_intact_ = 0;
  std::uint64_t last_cycle_ = 0;
  std::int64_t last_due_ = 0;
  std::vector<Gap> gaps_;
  std::array<std::uint64_t, 64> ages_{};  ///< arrival - due, four buckets an octave from 1 µs
  std::int64_t oldest_ns_ = 0;
  std::array<std::pair<std::uint64_t, JointVector>, kRemembered> sent_{};
  std::uint64_t feedbacks_ = 0, last_feedback_cycle_ = 0;
  JointVector worst_following_{};
};

}  // namespace meridian::record
