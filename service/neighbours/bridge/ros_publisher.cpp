// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/bridge/ros_publisher.hpp"

#include "meridian/kinematics/limited.hpp"
#include "service/neighbours/ros/messages.hpp"
#include "service/neighbours/ros/urdf.hpp"

namespace meridian::bridge {

RosPublisher::RosPublisher(dds::Participant& participant, const MachineModel& model,
                           std::int64_t time_ns)
    : joint_states_(participant, dds::RosTopic::kJointStates),
      transforms_(participant, dds::RosTopic::kTransforms),
      static_transforms_(participant, dds::RosTopic::kStaticTransforms),
      description_(participant, dds::RosTopic::kRobotDescription),
      diagnostics_(participant, dds::RosTopic::kDiagnostics),
      model_(model),
      frames_(model) {
  describe(model, time_ns);
}

void RosPublisher::send(dds::RosWriter& writer) {
  if (!writer.write(message_.bytes())) ++refused_;
}

void RosPublisher::describe(const MachineModel& model, std::int64_t time_ns) {
  model_ = model;
  frames_ = scene::LinkFrames(model_);
  message_.begin().put(ros::urdf_of(model_));
  send(description_);
  const auto& frames = frames_.at(JointVector{}, model_.tool_length_mm);
  fixed_.clear();
  for (const scene::LinkFrame& frame : frames) {
    if (frame.name == "tool" || frame.name == "workpiece") fixed_.push_back(frame);
  }
  if (ros::put_transforms(message_, time_ns, fixed_)) send(static_transforms_);
}

void RosPublisher::publish_joints(std::int64_t time_ns, const JointVector& joints,
                                  const std::optional<JointVector>& velocity) {
  const LimitedVector position = limited_of(model_, joints);
  LimitedVector speed{};
  const bool has_speed = velocity && !has_stage(model_);
  for (std::size_t i = 0; has_speed && i < velocity->size(); ++i) speed[i] = (*velocity)[i];
  ros::put_joint_state(message_, time_ns, model_, position, has_speed ? &speed : nullptr);
  send(joint_states_);
  moving_.clear();
  for (const scene::LinkFrame& frame : frames_.at(joints, model_.tool_length_mm)) {
    if (frame.name != "tool" && frame.name != "workpiece") moving_.push_back(frame);
  }
  if (ros::put_transforms(message_, time_ns, moving_)) send(transforms_);
}

void RosPublisher::publish_diagnostics(std::int64_t time_ns, const std::vector<Diagnosis>& all) {
  put_diagnostics(message_, time_ns, model_.name, all);
  send(diagnostics_);
}

RosCounts RosPublisher::counts() const noexcept {
  return {joint_states_.sent(), transforms_.sent(), description_.sent(), diagnostics_.sent(),
          refused_};
}

}  // namespace meridian::bridge
