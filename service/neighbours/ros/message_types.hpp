// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/mcap/writer.hpp"

/// The ROS 2 messages of a recording as their definitions say them, which an MCAP file carries with
/// it (`ros2msg`). Those of ROS packages have the fields that they have there; those of
/// meridian_msgs are made for the machine, with its joints for names of fields.
namespace meridian::ros {

/// What a file of rows holds beside the joints; what it does not hold has no field.
struct Contents {
  bool has_velocity = true;
  bool has_state = true;         ///< state, kind, block, rate and times of the cycle
  bool has_alarm = false;        ///< of the flight recorder
  bool has_feedback = false;     ///< where drives said they are
  bool has_statuswords = false;  ///< what else they said
};

struct MessageType {
  std::string name;  ///< package/msg/Type
  std::string text;  ///< its definition, and those that it refers to
};

[[nodiscard]] MessageType joint_state_type();
[[nodiscard]] MessageType pose_stamped_type();
[[nodiscard]] MessageType log_type();
[[nodiscard]] MessageType transforms_type();
[[nodiscard]] MessageType markers_type();
/// With a field for everything that has limits (limited.hpp), and one for every drive.
[[nodiscard]] MessageType cycle_type(const MachineModel& model, const Contents& contents);
/// A field for everything that has limits (limited.hpp).
[[nodiscard]] MessageType limit_shares_type(const MachineModel& model);
/// A field for every drive.
[[nodiscard]] MessageType drives_type(const MachineModel& model, const Contents& contents);

/// `names` as names of fields: small letters, digits and underscores, no two the same.
[[nodiscard]] std::vector<std::string> field_names(const std::vector<std::string>& names);

/// Adds the channel of a topic with its type. Returns the channel's number.
[[nodiscard]] std::uint16_t add_topic(mcap::Writer& writer, std::string_view topic,
                                      const MessageType& type);

}  // namespace meridian::ros
