// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/move_forecast.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "meridian/cycle/state_table.hpp"
#include "meridian/geometry/segment.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/analysis/simulate/simulate.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/text/printed.hpp"

namespace meridian::simulate {

namespace {

/// The move as the service will do it, with the events of `events`; `follow` gets every cycle that
/// leads the joints.
SimulateReport simulate_move(const stream::StraightMove& move, const JointVector& joints,
                             const MachineModel& model, const OperatorEvents& events,
                             const std::function<void(const CycleRecord&)>& follow) {
  SimulateOptions options;
  options.start = has_stage(model) ? drives_of(model, joints) : joints;
  options.settings.transition = Transition::kExactStop;
  options.settings.first_joints = move.joints;
  options.settings.ends_exactly = true;
  options.events = events;
  const std::string text = program_of(move);
  cl::ClReader reader(std::string_view(text), "move");
  return simulate(reader, "move", model, {}, options, [&follow](const CycleRecord& record) {
    if (is_leading(record.setpoint.flags)) follow(record);
  });
}

[[nodiscard]] Vector3 tip_of(const MachineModel& model, const JointVector& joints) {
  return forward(model, model.tool_length_mm, joints).tip;
}

/// So many cycles of moves are simulated to find where they stop.
constexpr std::size_t kStopCycles = 100'000;

/// The tips of the cycles from that of the start on, of a move that is aborted in cycle `abort`
/// of these; 0: in none.
[[nodiscard]] std::vector<Vector3> tips_of(const stream::StraightMove& move,
                                           const JointVector& joints, const MachineModel& model,
                                           std::int64_t abort) {
  OperatorEvents events;
  if (abort > 0) events.verbs.push_back({abort, Verb::kAbort, 0});
  std::vector<Vector3> tips;
  (void)simulate_move(move, joints, model, events, [&](const CycleRecord& record) {
    if (is_on_path(record.state) || !tips.empty()) tips.push_back(tip_of(model, record.joints));
  });
  return tips;
}

}  // namespace

MoveForecast forecast(const stream::StraightMove& move, const JointVector& joints,
                      const MachineModel& model) {
  MoveForecast found;
  found.joints = joints;
  double farthest_mm = 0;
  const auto follow = [&](const CycleRecord& record) {
    found.joints = record.joints;
    const Vector3 tip = tip_of(model, record.joints);
    farthest_mm = std::max(farthest_mm, distance_to_segment(tip, move.from.tip, move.to.tip));
  };
  const SimulateReport report = simulate_move(move, joints, model, {}, follow);
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

double stop_distance_mm(const stream::StraightMove& move, const JointVector& joints,
                        const MachineModel& model) {
  const std::vector<Vector3> whole = tips_of(move, joints, model, 0);
  const auto step_of = [&whole](std::size_t n) { return (whole[n] - whole[n - 1]).norm(); };
  std::vector<std::size_t> begins;
  std::size_t fastest = 1;
  for (std::size_t n = 2; n < whole.size(); ++n) {
    if (step_of(n) > step_of(fastest)) fastest = n;
  }
  begins.push_back(fastest);
  // A slow move is long: fewer samples of it take as long.
  const std::size_t count = kStopCycles / std::max<std::size_t>(whole.size(), 1);
  const std::size_t samples = std::clamp<std::size_t>(count, 4, kStopSamples);
  for (std::size_t n = 1; n < samples; ++n) begins.push_back(n * whole.size() / samples);
  double longest_mm = 0;
  for (const std::size_t begin : begins) {
    if (begin < 1 || begin >= whole.size()) continue;
    const auto tips = tips_of(move, joints, model, static_cast<std::int64_t>(begin));
    longest_mm = std::max(longest_mm, (tips.back() - whole[begin - 1]).norm());
  }
  return longest_mm + (whole.size() > 1 ? step_of(fastest) : 0);
}

}  // namespace meridian::simulate
