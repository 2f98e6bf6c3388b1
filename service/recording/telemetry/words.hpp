// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/planner/approach.hpp"
#include "meridian/planner/relaxed_axis.hpp"
#include "meridian/planner/rewind.hpp"

/// What the cycle reports in numbers, in words for operators and the log.
namespace meridian::telemetry {

/// How much an event matters to who reads the log.
enum class Weight : std::uint8_t { kDetail, kNews, kWarning, kError };

[[nodiscard]] Weight weight_of(const Event& event) noexcept;
/// Names of the drives of `mask`, in drive order: "b3, theta1".
[[nodiscard]] std::string drive_names(std::uint32_t mask, const MachineModel& model);
/// One sentence, with units; alarms name joint, line and remedy.
[[nodiscard]] std::string describe(const Event& event, const MachineModel& model);
/// An alarm with its joint and measured value, what it means and what to do.
[[nodiscard]] std::string describe(Alarm alarm, int joint, double value, std::uint32_t line,
                                   const MachineModel& model);
/// Where the tool axis will be moved beside the pole, by how much and why.
[[nodiscard]] std::string describe(const RelaxedAxis& relaxed_axis);
[[nodiscard]] std::string describe(const Rewind& rewind);
/// How the machine will come to a program's first motion, in at most `room` characters where they
/// hold what cannot be left out: line, how far off the part its first actions are done, length,
/// time and branch; then joints with what they move by; then the winding.
[[nodiscard]] std::string describe(const Approach& approach, const MachineModel& model,
                                   std::size_t room);
/// Whether tool and spindle act nearer to the part than the clearance, for want of travel.
[[nodiscard]] bool is_short_of_clearance(const Approach& approach,
                                         const MachineModel& model) noexcept;

}  // namespace meridian::telemetry
