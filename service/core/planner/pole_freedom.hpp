// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/machine_model.hpp"
#include "service/core/planner/pole_probes.hpp"
#include "service/core/planner/programmed_axis.hpp"

namespace meridian {

/// How far the tool axis comes off the programmed one where the free joint may be anywhere.
///
///        _.──._
///      .'      `.            The free joint turns the line through the pole on which the axis is,
///     ● pole     ● axis      the tilt finds its place closest to the axis of the path: what
///      `._    _.'            results lies on the circle over both, and none of it is farther from
///         `──'   × programmed    the programmed axis than the centre and half the width.
///
/// What it says depends on spans and programmed axis alone. Units: mm, rad. Source: docs/motion.md,
/// eq. 10.2.
class PoleFreedom {
 public:
  PoleFreedom(const MachineModel& model, const PoleProbes& probes,
              const ProgrammedAxis& programmed) noexcept
      : model_(model), probes_(probes), programmed_(programmed) {}

  /// The largest angle to the programmed axis at `u` over all values of the free joint; infinite
  /// where the programmed axis is not known.
  [[nodiscard]] double most_off_at(double u) const noexcept;

  /// Whether that is below `limit_rad` at `place` and at the ends of blocks on the way to it from
  /// the place ahead of it.
  [[nodiscard]] bool is_below(double limit_rad, PoleProbes::Place place) const noexcept;

 private:
  const MachineModel& model_;
  const PoleProbes& probes_;
  const ProgrammedAxis& programmed_;
};

}  // namespace meridian
