// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/check/check.hpp"
#include "service/recording/record/check/motion/creep_check.hpp"
#include "service/recording/record/check/motion/speed_check.hpp"
#include "service/recording/record/check/motion/time_check.hpp"
#include "service/recording/record/check/path/path_matching.hpp"
#include "service/recording/record/check/path/vertex_check.hpp"

namespace meridian::record {

/// Holds the tool against the path: is there a matching of the two, how far are poses off it, how
/// fast does the tool go, how long do blocks take. Rows of the cut alone, in order. Units: mm, rad,
/// s. Proof: tests/unit/record/check_test.cpp, spoilt_recording_test.cpp.
class PathCheck {
 public:
  /// Both tolerances of `options` are in force.
  PathCheck(const MachineModel& model, const CheckedPath& path, const CheckOptions& options);

  /// `missing`: cycles before this row that have no row. Rows off the path, as while the free joint
  /// is rewound, are left out and not missing.
  void add(const RecordingRow& row, std::uint64_t missing);
  /// Checks what is left and adds what was found to the report.
  void finish(CheckReport& report);

 private:
  struct Sample {
    std::uint64_t cycle = 0;
    std::uint32_t line = 0;
    JointVector joints{};
    std::uint64_t missing = 0;
    double plan_time_s = 0;
    bool is_running = false;
  };
  /// How far poses are off the path.
  struct Deviations {
    Peak tip, axis, tip_between, axis_between;
    Excess tip_over, axis_over;
    double exceeded_axis = 0;  ///< what was allowed where the axis was farthest off
  };
  void step(bool has_between);
  void match(const JointVector& joints, const Sample& at, bool is_setpoint);
  void note(PathMatching::Step step, const Sample& at, bool is_setpoint);
  void compare_speeds(const Sample& from, const Sample& to, PathMatching::Position low);
  [[nodiscard]] double rate_between(const Sample& from, const Sample& to) const noexcept;
  void find_deviations(CheckReport& report) const;
  void find_disorder(CheckReport& report, bool is_at_end) const;
  [[nodiscard]] PathMatching::Gap gap_before(const Sample& at) const;
  [[nodiscard]] double axis_tolerance_at(const Vector3& axis) const noexcept;
  [[nodiscard]] double common_length(PathMatching::Position at) const noexcept;

  const MachineModel& model_;
  const CheckedPath& path_;
  CheckOptions options_;
  std::vector<PathElement> elements_;  ///< of a path that is one pose: one that stands there
  PathMatching matching_;
  VertexCheck vertices_;
  SpeedCheck speeds_;
  TimeCheck times_;
  CreepCheck creep_;
  Tolerance tolerance_;              ///< at the last pose
  std::array<Sample, 4> samples_{};  ///< newest last
  int known_ = 0;                    ///< how many of them are filled
  int run_ = 0;                      ///< consecutive cycles at their end
  PathMatching::Step last_step_ = PathMatching::Step::kWithin;
  Deviations now_, before_;  ///< before_: before the matching was widened
  Peak broken_;              ///< where it was lost first
};

}  // namespace meridian::record
