// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::record {

/// What the comparison of two recordings found.
struct ComparisonReport {
  std::uint64_t rows_a = 0, rows_b = 0;  ///< from the first motion on
  std::uint64_t compared = 0;            ///< rows of A and B at the same plan time
  std::uint64_t only_a = 0, only_b = 0;  ///< plan times that the other one has not sent
  std::uint64_t gaps_a = 0, gaps_b = 0;  ///< cycles missing in each
  std::uint64_t different = 0;           ///< compared rows whose joints or drives differ
  /// Plan times of one that lie neither on the other's nor in a gap of the other's cycles.
  std::uint64_t unexplained = 0;
  std::uint64_t first_difference_a = 0, first_difference_b = 0;  ///< cycles
  std::uint32_t first_line = 0;
  int first_joint = -1;
  double first_a = 0, first_b = 0, first_plan_time_s = 0;
  double largest_difference = 0;  ///< of any joint, mm or rad

  [[nodiscard]] bool is_same() const noexcept {
    return compared > 0 && different == 0 && unexplained == 0;
  }
};

/// Checks whether two recordings hold the same motion, bit for bit on every cycle that both sent.
///
/// Rows are aligned by plan time, from the first cycle in which the joints move; so neither what
/// went before, nor how long an action was waited for, nor cycles that one of them lost matter.
/// Proof: tests/unit/record/compare_test.cpp.
[[nodiscard]] Expected<ComparisonReport, RecordError> compare(RecordingReader& a,
                                                              RecordingReader& b,
                                                              const MachineModel& model);

[[nodiscard]] std::string to_text(const ComparisonReport& report, const std::string& name_a,
                                  const std::string& name_b, const MachineModel& model);

}  // namespace meridian::record
