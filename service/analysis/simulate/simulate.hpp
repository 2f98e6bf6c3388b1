// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "meridian/planner/smooth_planner.hpp"
#include "service/analysis/certify/certifier.hpp"
#include "service/analysis/simulate/explainer.hpp"
#include "service/analysis/simulate/operator_events.hpp"
#include "service/analysis/simulate/simulate_report.hpp"
#include "service/programs/cl/cl_reader.hpp"

namespace meridian::simulate {

struct SimulateOptions {
  std::optional<JointVector> start;         ///< where the drives are when enabled; nothing: home
  SmoothSettings settings;                  ///< what the session of a live station would ask for
  OperatorEvents events;                    ///< replayed
  bool has_action_peer = true;              ///< false: programs with action words are refused
  bool stops_at_optional = false;           ///< optional stops stop
  Explainer* explainer = nullptr;           ///< follows the program from the end of its approach
  certify::Certifier* certifier = nullptr;  ///< gets every piece of plan that is published
};

/// Runs a CL file through check, planner and cycle as the service does, without DDS and without a
/// clock: drives that are ideal (feedback is the last setpoint, enabled at once), actions that are
/// done at once, or when the events say, an operator who enables, starts, and resumes at program
/// stops, unless the events list the resumes.
///
/// The motion is that of the service, bit for bit on every cycle that it sends. `take` gets every
/// cycle. Context: a tool's main thread; memory is fixed but for the reader's.
/// Proof: tests/unit/simulate, tests/corpus/simulate_corpus_test.cpp.
[[nodiscard]] SimulateReport simulate(cl::ClReader& reader, const std::string& name,
                                      const MachineModel& model, const ToolTable& tools,
                                      const SimulateOptions& options,
                                      const std::function<void(const CycleRecord&)>& take);

}  // namespace meridian::simulate
