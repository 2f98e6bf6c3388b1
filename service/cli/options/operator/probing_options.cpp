// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/operator/probing_options.hpp"

#include <algorithm>
#include <cstdio>

#include "meridian/cycle/state_table.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/analysis/simulate/move_forecast.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/options/operator/move_options.hpp"
#include "service/cli/options/operator/print_end.hpp"
#include "service/cli/options/operator/reported_machine.hpp"
#include "service/cli/options/operator/touch_off_options.hpp"
#include "service/protocol/frame_sum.hpp"
#include "service/protocol/limits_sum.hpp"
#include "service/protocol/operator/probe_run.hpp"
#include "service/text/printed.hpp"

namespace meridian::cli {
namespace {

/// Why the machine begins no probing move as it is; empty: it does.
[[nodiscard]] std::string hindrance(const dds::Status& status) {
  if (status.state != State::kReady || status.session != 0) {
    return "the machine is " + std::string(name_of(status.state)) +
           "; a probing move begins in Ready, with no program";
  }
  if (status.is_dry_run) {
    return "this is a dry run, in which no drive moves; disable, dry-run off, enable, then repeat";
  }
  if (status.probe == ProbeInput::kNone) {
    return "the drives report no probe that is connected; connect it, then repeat";
  }
  if (status.probe == ProbeInput::kContact) return "the probe is in contact; move it free first";
  return "";
}

/// The machine, and what is asked of it.
struct ProbingRun {
  const ProbingOptions& options;
  const dds::MachineInfo& machine;
  MachineModel model;
  dds::Participant& participant;
  stream::OperatorLink& link;
  const std::string& operator_name;
  std::chrono::milliseconds timeout;
  Vector3 from;  ///< where the tip began
};

[[nodiscard]] stream::MoveOrder order_of(const ProbingRun& probing, const Vector3& to) {
  const dds::Status& status = *probing.link.status();
  const ToolPose from = forward(probing.model, status.tool_length_mm, status.joints);
  return {{from, {to, from.axis}, *probing.options.feed, {}},
          status.joints,
          status.tool_length_mm,
          probing.operator_name,
          stream::frame_sum(probing.model, probing.machine.work_frames),
          status.tools,
          stream::limits_sum(probing.machine.soft_limits)};
}

void print_contact(const ProbingRun& probing, const dds::Status& status,
                   const ContactReport& found) {
  const double period_ms = 1e-6 * static_cast<double>(probing.model.cycle_ns);
  std::printf("contact at %.4f %.4f %.4f mm, uncertainty %.4f mm (%u period%s of %.4g ms)\n",
              found.tip.x(), found.tip.y(), found.tip.z(), found.uncertainty_mm,
              status.contact_periods, status.contact_periods == 1 ? "" : "s", period_ms);
  std::printf("overtravel %.4f mm\n", found.overtravel_mm);
  std::fflush(stdout);
}

/// Adds the contact to the file of the touches: the exit code.
[[nodiscard]] int note_contact(const ProbingRun& probing, const ToolOptions& tool,
                               dds::Status status) {
  if (probing.options.touches.empty()) return kFine;
  status.joints = status.contact_joints;
  const auto toward = direction_of(probing.options.toward, probing.model);
  const auto touch = touch_of(status, probing.machine, tool, *toward);
  if (!touch) return print_failure(touch.error(), kUsage);
  if (!append_touch(probing.options.touches, *touch)) {
    return print_failure(probing.options.touches + ": cannot be written", kVerdictNo);
  }
  std::printf("noted in %s\n", probing.options.touches.c_str());
  return kFine;
}

/// Back along the line from the contact: the exit code. Whoever stopped the machine meanwhile wants
/// it to stand.
[[nodiscard]] int retract(const ProbingRun& probing, const stream::ProbeResult& result,
                          const Vector3& contact, const Vector3& toward) {
  if (!probing.options.retract_mm) return kFine;
  if (result.was_stopped || stop_flag().load()) {
    return print_failure("it was stopped meanwhile, and stands where it rests: no retract",
                         kVerdictNo);
  }
  const dds::Status status = *probing.link.status();
  const double approach_mm = (contact - probing.from).norm();
  const double by_mm = std::min(*probing.options.retract_mm, approach_mm);
  const stream::MoveOrder order = order_of(probing, contact - by_mm * toward);
  const auto forecast = simulate::forecast(order.move, status.joints, probing.model);
  if (!forecast.refusal.empty()) return print_refusal(forecast.refusal);
  const auto moved =
      stream::run_move(probing.participant, probing.link, order, stop_flag(), probing.timeout);
  if (moved.end == stream::MoveEnd::kRefused) return print_refusal(moved.text);
  if (moved.end == stream::MoveEnd::kNoAnswer) {
    return print_silence();
  }
  if (moved.end == stream::MoveEnd::kStopped) {
    return print_failure("the retract was stopped: " + moved.text, kVerdictNo);
  }
  std::printf("back by %.4f mm\n", by_mm);
  return kFine;
}

/// What came of the move: the exit code.
[[nodiscard]] int conclude(const ProbingRun& probing, const ToolOptions& tool,
                           const stream::ProbeResult& result, const Vector3& toward) {
  switch (result.end) {
    case stream::ProbeEnd::kContact:
      break;
    case stream::ProbeEnd::kNoContact:
      return print_failure(text::printed("no contact within %.10g mm; the tip stands at their end",
                                         probing.options.distance_mm),
                           kVerdictNo);
    case stream::ProbeEnd::kRefused:
      return print_refusal(result.text);
    case stream::ProbeEnd::kStopped:
      return print_failure("stopped without contact: " + result.text, kVerdictNo);
    case stream::ProbeEnd::kNoAnswer:
      return print_silence();
  }
  const ContactReport found = contact_of(result.status, probing.model);
  print_contact(probing, result.status, found);
  const int exit_code = note_contact(probing, tool, result.status);
  if (result.status.state != State::kReady) {
    return print_failure("after the contact: " + result.status.message, kVerdictNo);
  }
  return exit_code == kFine ? retract(probing, result, found.tip, toward) : exit_code;
}

}  // namespace

std::optional<Vector3> axis_of_work_frame(const std::string& word) {
  MachineModel in_frame;
  in_frame.X_MW.rotation = Eigen::Matrix3d::Identity();
  return direction_of(word, in_frame);
}

ContactReport contact_of(const dds::Status& status, const MachineModel& model) {
  const auto tip = [&](const JointVector& joints) {
    return forward(model, status.tool_length_mm, joints).tip;
  };
  ContactReport report;
  report.tip = tip(status.contact_joints);
  report.uncertainty_mm = (report.tip - tip(status.contact_free_joints)).norm();
  report.overtravel_mm = (tip(status.joints) - report.tip).norm();
  return report;
}

int run_probing(const ProbingOptions& options, const ToolOptions& tool,
                const dds::MachineInfo& machine, dds::Participant& participant,
                stream::OperatorLink& link, const std::string& operator_name,
                const PeerOptions& peer) {
  const auto toward = axis_of_work_frame(options.toward);
  if (!toward || !(options.distance_mm > 0) || !options.feed) {
    return print_failure("probe needs --toward -x, +x, -y, +y, -z or +z, --distance and --feed",
                         kUsage);
  }
  if (options.retract_mm.value_or(0) > options.distance_mm) {
    return print_failure("--retract goes back along the line: no farther than --distance", kUsage);
  }
  auto model = reported_machine(machine);
  if (!model) return print_failure("the machine does not publish its file", kVerdictNo);
  if (!link.wait_for_status(peer.timeout())) {
    return print_failure("machine " + machine.name + " does not answer", kNoPeer);
  }
  const dds::Status status = *link.status();
  if (const std::string why = hindrance(status); !why.empty()) return print_refusal(why);
  model->tool_length_mm = status.tool_length_mm;
  if (!options.touches.empty()) {
    const auto touch = touch_of(status, machine, tool, *toward);
    if (!touch) return print_failure(touch.error(), kUsage);
  }
  const ToolPose from = forward(*model, status.tool_length_mm, status.joints);
  const ProbingRun probing{options, machine,       *model,         participant,
                           link,    operator_name, peer.timeout(), from.tip};
  const stream::MoveOrder order = order_of(probing, from.tip + options.distance_mm * *toward);
  const simulate::MoveForecast forecast = simulate::forecast(order.move, status.joints, *model);
  if (!forecast.refusal.empty()) return print_refusal(forecast.refusal);
  print_pose("from", order.move.from);
  print_pose("to  ", order.move.to);
  std::printf("stop distance %.4f mm at %.10g mm/min, and what the drives lag behind\n",
              simulate::stop_distance_mm(order.move, status.joints, *model), *options.feed);
  std::fflush(stdout);
  watch_for_stop();
  const auto result = stream::run_probe(participant, link, order, stop_flag(), peer.timeout());
  return conclude(probing, tool, result, *toward);
}

}  // namespace meridian::cli
