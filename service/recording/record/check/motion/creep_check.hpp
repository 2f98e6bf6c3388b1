// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/check/check_report.hpp"

namespace meridian::record {

/// Finds a machine that runs and gets nowhere: for more than 10 s the tip is slower than a
/// thousandth of the programmed feed, and every joint than a thousandth of its velocity limit. A
/// vertex that is passed takes a tenth of a second off: tiny blocks that rest at each are no creep.
/// Units: mm, rad, s. Proof: tests/unit/record/creep_check_test.cpp.
class CreepCheck {
 public:
  explicit CreepCheck(const MachineModel& model)
      : model_(model), period_(static_cast<double>(model.cycle_ns) * 1e-9) {}

  /// What happens from one cycle to the next, that of `cycle`.
  struct Move {
    const JointVector& from;
    const JointVector& to;
    double tip_mm = 0;         ///< how far the tip goes
    double feed_mm_per_s = 0;  ///< programmed there
    std::size_t vertices = 0;  ///< passed
    double rate = 0;           ///< plan time per time; 0: at rest, or not running
  };
  void add(const Move& move, std::uint64_t cycle, std::uint32_t line);
  /// Adds what was found to the report.
  void finish(CheckReport& report) const;

 private:
  [[nodiscard]] bool is_slow(const Move& move) const noexcept;

  const MachineModel& model_;
  double period_;
  double slow_s_ = 0;  ///< up to the last cycle
  std::uint64_t last_cycle_ = 0;
  Peak longest_s_;
};

}  // namespace meridian::record
