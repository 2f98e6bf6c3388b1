// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/controls/robot_axes.hpp"

#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/programs/post/controls/nc_text.hpp"

namespace meridian::post {
namespace {

[[nodiscard]] tl::unexpected<PostError> refuse(const MachineModel& model, const std::string& why) {
  return tl::make_unexpected(PostError{0, "machine " + model.name + ": " + why});
}

}  // namespace

Expected<RobotAxes, PostError> RobotAxes::of(const MachineModel& model, const AxisWords& words,
                                             const PostOptions& options) {
  RobotAxes axes;
  axes.count_ = words.count();
  axes.zero_deg_ = options.zero_deg;
  axes.is_forearm_coupled_ = options.is_forearm_coupled;
  if (axes.count_ > kRobotAxes) return refuse(model, "a robot's program has six axes at most");
  if (options.dialect == Dialect::kUrScript && axes.count_ != kRobotAxes) {
    return refuse(model,
                  "movej takes six joints, and the machine has " + std::to_string(axes.count_));
  }
  for (int k = 0; k < axes.count_; ++k) {
    const std::string address = "J" + std::to_string(k + 1);
    const int joint = words.find(address);
    if (joint < 0 || !words.is_rotary(joint)) {
      return refuse(model, "no rotary joint has nc_word = \"" + address + "\" (or \"-" + address +
                               "\"): robots' languages number their axes from J1 without a gap; "
                               "other machines are written with --dialect joints");
    }
    axes.joint_[k] = joint;
    axes.sign_[k] = words.sign(joint);
    axes.velocity_[k] = drive_spec(model, joint).limits.velocity;
  }
  return axes;
}

std::array<double, kRobotAxes> RobotAxes::shown_deg(const JointVector& drives) const {
  std::array<double, kRobotAxes> out{};
  for (int k = 0; k < count_; ++k) {
    double at = units::deg_from_rad(drives[joint_[k]]);
    if (k == 2 && is_forearm_coupled_) at += units::deg_from_rad(drives[joint_[1]]);
    out[k] = rounded(sign_[k] * at + zero_deg_[k], kRotaryDecimals);
  }
  return out;
}

std::array<double, kRobotAxes> RobotAxes::turned_rad(const JointVector& from,
                                                     const JointVector& to) const {
  std::array<double, kRobotAxes> out{};
  for (int k = 0; k < count_; ++k) out[k] = to[joint_[k]] - from[joint_[k]];
  return out;
}

}  // namespace meridian::post
