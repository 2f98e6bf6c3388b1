// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/move_forecast.hpp"

#include <algorithm>
#include <string_view>

#include "meridian/geometry/segment.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/analysis/simulate/simulate.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/text/printed.hpp"

namespace meridian::simulate {
MoveForecast forecast(const stream::StraightMove& move, const JointVector& joints,
                      const MachineModel& model) {
  MoveForecast found;
  found.joints = joints;
  double farthest_mm = 0;
  const auto follow = [&](const CycleRecord& record) {
    if (!is_leading(record.setpoint.flags)) return;
    found.joints = record.joints;
    const Vector3 tip = forward(model, model.tool_length_mm, record.joints).tip;
    farthest_mm = std::max(farthest_mm, distance_to_segment(tip, move.from.tip, move.to.tip));
  };
  SimulateOptions options;
  options.start = has_stage(model) ? drives_of(model, joints) : joints;
  options.settings.transition = Transition::kExactStop;
  options.settings.first_joints = move.joints;
  options.settings.ends_exactly = true;
  const std::string text = program_of(move);
  cl::ClReader reader(std::string_view(text), "move");
  const SimulateReport report = simulate(reader, "move", model, {}, options, follow);
  found.time_s = report.approach_s + report.program_s;
  if (report.outcome != Outcome::kDone) {
    found.refusal = report.reason.empty() ? "the simulated machine stopped" : report.reason;
  } else if (!move.joints && farthest_mm > kStraight_mm) {
    text::append(found.refusal,
                 "the tip would leave its straight line by %.3f mm, as joints must turn another "
                 "way round; jog them, or move by way of another point",
                 farthest_mm);
  }
  return found;
}

}  // namespace meridian::simulate
