// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "service/protocol/operator/move_program.hpp"

namespace meridian::simulate {

/// A move of the tip may be so far off its straight line, mm: what the joints are rounded to.
inline constexpr double kStraight_mm = 1e-6;

/// What a straight move comes to. Units: mm, s.
struct MoveForecast {
  std::string refusal;   ///< why it cannot be done from there, one sentence; empty: it can
  double time_s = 0;     ///< at overrides of 100 %
  JointVector joints{};  ///< at its end
};

/// Simulates `move` from `joints`, which are at rest, in exact stop, with the tool in the spindle
/// as `model` has it: as the service will do it. Refused are what the service refuses, and moves on
/// whose way the tip would leave the straight line: where it has to be approached by another branch
/// or winding, or the redundant joint is rewound. A move of the joints takes the tip where they
/// lead it. Context: a tool's main thread. Proof: tests/unit/simulate/move_forecast_test.cpp.
[[nodiscard]] MoveForecast forecast(const stream::StraightMove& move, const JointVector& joints,
                                    const MachineModel& model);

/// How far the tip goes on, mm, where the move is aborted on its way: the longest of up to
/// kStopSamples stops that begin all along it, by its setpoints, and what it goes in the period in
/// which the reason for a stop is reported. `move` can be done (forecast()). Context: as
/// forecast(). Proof: tests/integration/drawn_probing_test.cpp.
[[nodiscard]] double stop_distance_mm(const stream::StraightMove& move, const JointVector& joints,
                                      const MachineModel& model);

inline constexpr int kStopSamples = 24;

}  // namespace meridian::simulate
