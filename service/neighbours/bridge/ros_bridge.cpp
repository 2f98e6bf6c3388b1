// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/bridge/ros_bridge.hpp"

#include "meridian/kinematics/limited.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/protocol/operator/served_model.hpp"

namespace meridian::bridge {
namespace {

constexpr std::int64_t kDiagnosticsPeriod_ns = 1'000'000'000, kStale_ns = 2'000'000'000;
constexpr int kWaiting = 64;  ///< of several groups of drives, or services, between two steps

/// Whether ROS 2 has a description of the machine that does not hold any more.
[[nodiscard]] bool is_outdated(const MachineModel& published, const MachineModel& now) {
  return published.tool_length_mm != now.tool_length_mm ||
         published.X_MW.origin_mm != now.X_MW.origin_mm ||
         published.X_MW.rotation != now.X_MW.rotation;
}

}  // namespace

RosBridge::RosBridge(dds::Participant& machine, dds::Participant& ros, const MachineModel& model,
                     BridgeTime now)
    : machines_(machine),
      statuses_(machine),
      setpoints_(machine, {}, kWaiting),
      feedbacks_(machine, {}, kWaiting),
      publisher_(ros, model, now.system_ns),
      drives_(model.joint_count) {}

void RosBridge::take(BridgeTime now) {
  dds::DriveFeedback feedback;
  while (feedbacks_.take(feedback)) {
    drives_.add(feedback, now.steady_ns);
    sent_.follow(feedback.service_id);
    is_news_ = true;
  }
  drives_.pass(now.steady_ns);
  dds::Status status;
  if (followed_status_.take(statuses_, status)) {
    status_ = status;
    status_ns_ = now.steady_ns;
    if (!drives_.all()) sent_.follow(status.service_id);
  }
  dds::SetpointSample setpoint;
  while (setpoints_.take(setpoint)) {
    if (sent_.add(setpoint, now.steady_ns)) is_news_ = true;
  }
  sent_.pass(now.steady_ns);
  if (status_ && now.steady_ns - status_ns_ > kStale_ns) status_.reset();
}

void RosBridge::publish_joints(std::int64_t system_ns) {
  const MachineModel& model = publisher_.model();
  const std::optional<JointVector> reported = drives_.all();
  const std::optional<Setpoint>& sent = sent_.get();
  if (!reported && !sent) return;
  const JointVector joints = joints_of(model, reported ? *reported : sent->position);
  std::optional<JointVector> velocity;
  if (sent) velocity = joint_velocity_of(model, joints, sent->velocity);
  publisher_.publish_joints(system_ns, joints, velocity);
}

std::optional<MachineModel> RosBridge::newly_served() {
  dds::MachineInfo info;
  if (!followed_machine_.take(machines_, info) || info.machine_file.empty()) return std::nullopt;
  try {
    return stream::served_model(info);
  } catch (const config::ConfigError&) {
    return std::nullopt;  // another version wrote it: what was described first stays
  }
}

void RosBridge::describe(std::int64_t system_ns) {
  const MachineModel& described = publisher_.model();
  std::optional<MachineModel> model = newly_served();
  // The machine topic has the tool of the machine file, the status the one in the spindle.
  const bool is_other_tool = status_ && status_->tool_length_mm != described.tool_length_mm;
  if (!model && !is_other_tool) return;
  if (!model) model = described;
  if (status_) model->tool_length_mm = status_->tool_length_mm;
  if (is_outdated(described, *model)) publisher_.describe(*model, system_ns);
}

void RosBridge::work(BridgeTime now) {
  take(now);
  describe(now.system_ns);
  if (is_news_) publish_joints(now.system_ns);
  is_news_ = false;
  if (now.steady_ns - diagnosed_ns_ < kDiagnosticsPeriod_ns) return;
  diagnosed_ns_ = now.steady_ns;
  publisher_.publish_diagnostics(
      now.system_ns, diagnose(publisher_.model(), status_ ? &*status_ : nullptr, drives_));
}

}  // namespace meridian::bridge
