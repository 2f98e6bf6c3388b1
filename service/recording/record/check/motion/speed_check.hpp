// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/check/check.hpp"
#include "service/recording/record/check/path/path_matching.hpp"

namespace meridian::record {

/// Checks how fast tip and axis go between setpoints: no faster than what blocks there ask for,
/// times the feed override in force. Units: mm, rad, s. Proof: tests/unit/record/check_test.cpp,
/// check_inverse_time_test.cpp.
class SpeedCheck {
 public:
  SpeedCheck(const MachineModel& model, const CheckedPath& path, const CheckOptions& options);

  /// The fastest tip speed that blocks between two positions ask for, mm/s.
  [[nodiscard]] double feed_between(PathMatching::Position low,
                                    PathMatching::Position high) const noexcept {
    return asked_between(low, high).tip_mm_per_s;
  }

  /// From one setpoint to the next one, which is that of `cycle`; all matchings of the two are
  /// between `low` and `high`. Cycles go up.
  void add(const ToolPose& from, const ToolPose& to, PathMatching::Position low,
           PathMatching::Position high, std::uint64_t cycle, std::uint32_t line);
  /// Adds what was found to the report.
  void finish(CheckReport& report) const;

 private:
  /// How fast tip and axis may be.
  struct Speeds {
    double tip_mm_per_s = 0, turn_rad_per_s = 0;
  };
  [[nodiscard]] Speeds asked_between(PathMatching::Position low,
                                     PathMatching::Position high) const noexcept;

  const MachineModel& model_;
  const CheckedPath& path_;
  CheckOptions options_;
  double period_;
  FeedInForce overrides_;
  Peak feed_, speed_;
  Excess feed_over_, turn_over_;
};

}  // namespace meridian::record
