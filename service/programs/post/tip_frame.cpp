// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/tip_frame.hpp"

#include <Eigen/LU>
#include <array>
#include <string>

#include "meridian/kinematics/jacobian.hpp"
#include "meridian/kinematics/kinematics.hpp"

namespace meridian::post {
namespace {

[[nodiscard]] PostError refuse(const MachineModel& model, const std::string& what) {
  return {0, "tool-centre words need X, Y and Z along the machine's axes; on machine " +
                 model.name + " " + what + " (--dialect joints can write it)"};
}

/// Where the spindle does not stand along Z no word is wrong, but the frame that the file counts
/// in.
std::string remedy_of(const MachineModel& model, int joint) {
  return is_spindle_along_z(model)
             ? "nc_word of joint " + model.joints[static_cast<std::size_t>(joint)].name
             : "the frame: the spindle does not stand along its +Z, as that of the control "
               "does; describe the machine with z along the spindle";
}

}  // namespace

Expected<JointVector, PostError> find_program_zero(const MachineModel& model,
                                                   const AxisWords& words) {
  constexpr std::array<std::string_view, 3> kAddresses = {"X", "Y", "Z"};
  constexpr double kAlong = 0.999999;
  const JointVector zero{};
  const ToolPose at_zero = forward(model, model.tool_length_mm, zero);
  const Jacobian motion = jacobian(model, model.tool_length_mm, zero);
  Eigen::Matrix3d by_words;
  std::array<int, 3> joints{};
  for (int k = 0; k < 3; ++k) {
    const std::string address(kAddresses[k]);
    joints[k] = words.find(address);
    if (joints[k] < 0 || words.is_rotary(joints[k])) {
      return tl::make_unexpected(refuse(model, "no linear joint is called " + address));
    }
    const Vector3 by_joint = motion.col(joints[k]).head<3>();
    by_words.col(k) = words.sign(joints[k]) * by_joint;
    if (!((model.X_MW.rotation * by_words.col(k))[k] > kAlong)) {
      return tl::make_unexpected(
          refuse(model, "word " + address + " does not move the tool along +" + address +
                            " of the part: check " + remedy_of(model, joints[k])));
    }
  }
  const Vector3 by = by_words.inverse() * -at_zero.tip;
  JointVector out{};
  for (int k = 0; k < 3; ++k) out[joints[k]] = words.sign(joints[k]) * by[k];
  return out;
}

bool is_spindle_along_z(const MachineModel& model) {
  constexpr double kAlong = 0.5;
  return in_program(model, forward(model, model.tool_length_mm, JointVector{})).axis.z() > kAlong;
}

ToolPose in_program(const MachineModel& model, const ToolPose& pose) {
  return {model.X_MW.rotation * pose.tip, model.X_MW.rotation * pose.axis};
}

}  // namespace meridian::post
