// SPDX-License-Identifier: Apache-2.0
#include "service/transport/ros_writer.hpp"

#include <dds/dds.h>
#include <idl/ros2.h>

#include <algorithm>
#include <string>

#include "service/transport/cyclone/write_cdr.h"
#include "service/transport/entity.hpp"

namespace meridian::dds {
namespace {

struct Spec {
  const char* name;
  const dds_topic_descriptor_t* type;
  std::int32_t depth;
  bool is_kept;  ///< for who comes late
};

/// Source: ROS 2, rmw_qos_profiles, and what joint_state_broadcaster, tf2_ros,
/// robot_state_publisher and diagnostic_updater publish with.
[[nodiscard]] Spec spec_of(RosTopic topic) noexcept {
  switch (topic) {
    case RosTopic::kJointStates:
      return {"rt/joint_states", &sensor_msgs_msg_dds__JointState__desc, 10, false};
    case RosTopic::kTransforms:
      return {"rt/tf", &tf2_msgs_msg_dds__TFMessage__desc, 100, false};
    case RosTopic::kStaticTransforms:
      return {"rt/tf_static", &tf2_msgs_msg_dds__TFMessage__desc, 1, true};
    case RosTopic::kRobotDescription:
      return {"rt/robot_description", &std_msgs_msg_dds__String__desc, 1, true};
    case RosTopic::kDiagnostics:
      break;
  }
  return {"rt/diagnostics", &diagnostic_msgs_msg_dds__DiagnosticArray__desc, 10, false};
}

[[nodiscard]] Qos qos_of(const Spec& spec) {
  Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, 0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, spec.depth);
  if (!spec.is_kept) return qos;
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, spec.depth, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  return qos;
}

}  // namespace

RosWriter::RosWriter(Participant& participant, RosTopic topic) {
  const Spec spec = spec_of(topic);
  const Qos qos = qos_of(spec);
  topic_ = dds_create_topic(participant.handle(), spec.type, spec.name, nullptr, nullptr);
  writer_ =
      topic_ < 0 ? topic_ : dds_create_writer(participant.publisher(), topic_, qos.get(), nullptr);
  if (writer_ < 0) {
    throw DdsError(std::string("DDS topic ") + spec.name +
                   " cannot be used: " + dds_strretcode(-writer_));
  }
}

RosWriter::~RosWriter() {
  dds_delete(writer_);
  dds_delete(topic_);
}

int RosWriter::matched_readers() const noexcept {
  return std::max(0, dds_get_matched_subscriptions(writer_, nullptr, 0));
}

bool RosWriter::write(std::string_view message) noexcept {
  const bool is_sent =
      meridian_write_cdr(writer_, message.data(), message.size()) == DDS_RETCODE_OK;
  if (is_sent) ++sent_;
  return is_sent;
}

}  // namespace meridian::dds
