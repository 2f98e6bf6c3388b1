// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/axis_words.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/kinematics/jacobian.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "service/programs/post/controls/nc_text.hpp"

namespace meridian::post {
namespace {

constexpr std::string_view kLetters = "XYZABCUVW";

[[nodiscard]] bool is_axis_letter(std::string_view text) {
  return text.size() == 1 && kLetters.find(text[0]) != std::string_view::npos;
}

/// Whether the stage's sliders stand in place of joint `i`.
[[nodiscard]] bool is_carried(const MachineModel& model, int i) {
  return has_stage(model) && (i == model.stage.linear_joint || i == model.stage.rotary_joint);
}

}  // namespace

Expected<AxisWords, PostError> AxisWords::of(const MachineModel& model) {
  AxisWords words;
  words.count_ = model.joint_count;
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& spec = drive_spec(model, i);
    Axis& axis = words.axes_[i];
    axis.is_rotary = spec.is_rotary;
    axis.address = spec.nc_word.empty() ? spec.name : spec.nc_word;
    if (spec.nc_word.empty() && !is_axis_letter(spec.name)) {
      const char* const table = is_carried(model, i) ? "stage." : "joints.";
      return tl::make_unexpected(
          PostError{0, "joint " + spec.name + " of machine " + model.name +
                           " has no NC word; write nc_word = \"X\" (its address; \"-X\" where the "
                           "controller counts against the joint) into [" +
                           table + spec.name + "] of the machine file"});
    }
    if (axis.address[0] == '-') {
      axis.sign = -1;
      axis.address.erase(0, 1);
    }
    for (int k = 0; k < i; ++k) {
      if (words.axes_[k].address != axis.address) continue;
      return tl::make_unexpected(PostError{0, "joints " + drive_spec(model, k).name + " and " +
                                                  spec.name + " of machine " + model.name +
                                                  " have the same NC word " + axis.address});
    }
  }
  return words;
}

int AxisWords::find(std::string_view address) const noexcept {
  for (int i = 0; i < count_; ++i) {
    if (axes_[i].address == address) return i;
  }
  return -1;
}

double AxisWords::value(int i, double at) const {
  const Axis& axis = axes_[i];
  return axis.is_rotary ? rounded(axis.sign * units::deg_from_rad(at), kRotaryDecimals)
                        : rounded(axis.sign * at, kLinearDecimals);
}

double AxisWords::axis(int i, double value) const noexcept {
  const Axis& axis = axes_[i];
  return axis.sign * (axis.is_rotary ? units::rad_from_deg(value) : value);
}

JointVector AxisWords::as_written(const JointVector& at) const {
  JointVector out{};
  for (int i = 0; i < count_; ++i) out[i] = axis(i, value(i, at[i]));
  return out;
}

std::string AxisWords::word(int i, double value) const {
  const Axis& axis = axes_[i];
  std::string out = axis.address;
  if (out.size() > 1) out += "=";
  return out + fixed(value, axis.is_rotary ? kRotaryDecimals : kLinearDecimals);
}

int retract_sense(const MachineModel& model, const AxisWords& words) {
  const int z = words.find("Z");
  if (z < 0 || words.is_rotary(z) || is_carried(model, z)) return 0;
  JointVector home{};
  for (int i = 0; i < model.joint_count; ++i) home[i] = model.joints[i].home;
  const Vector3 axis = forward(model, model.tool_length_mm, home).axis;
  const Vector3 motion = jacobian(model, model.tool_length_mm, home).col(z).head<3>();
  const double along = motion.dot(axis);
  constexpr double kParallel = 0.999;
  if (!(std::abs(along) > kParallel)) return 0;
  return along > 0 ? 1 : -1;
}

}  // namespace meridian::post
