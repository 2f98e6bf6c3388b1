// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/planner/motion_port.hpp"
#include "service/analysis/simulate/simulate_report.hpp"

namespace meridian::simulate {

/// Sees in each cycle which limit was nearest, by differences of the setpoints.
class LimitMeter {
 public:
  explicit LimitMeter(const MachineModel& model) : model_(model) {}

  /// `feed_mm_per_s`: planned for, 0 for none. Counts where the program moves.
  void add(const CycleRecord& record, double tool_length_mm, double feed_mm_per_s,
           LimitShares& shares);

 private:
  const MachineModel& model_;
  std::array<LimitedVector, 4> samples_{};  ///< newest last
  Vector3 tip_ = Vector3::Zero();
  int known_ = 0;
  std::uint64_t last_cycle_ = 0;
};

}  // namespace meridian::simulate
