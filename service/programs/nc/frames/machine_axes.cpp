// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/frames/machine_axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "meridian/kinematics/jacobian.hpp"
#include "meridian/units.hpp"
#include "service/programs/nc/remedy.hpp"
#include "service/programs/post/tip_frame.hpp"

namespace meridian::nc {

using cl::refuse;

namespace {

constexpr const char* kBeyondReach = "the machine does not reach the place where this move begins";
constexpr const char* kPartSetUp = "check the frame of the part (--frame) and the tool length";

}  // namespace

MachineAxes::MachineAxes(const MachineModel& model, const ToolTable& tools)
    : model_(model), tools_(tools) {
  auto words = post::AxisWords::of(model_);
  if (!words) {
    refusal_ = words.error().message;
  } else if (has_stage(model_)) {
    refusal_ = "machine " + model_.name + " has a stage, which no tool-centre control knows";
  } else if (const auto zero = post::find_program_zero(model_, *words); !zero) {
    refusal_ = zero.error().message;
  } else {
    words_ = *words;
  }
}

bool MachineAxes::is_rotary(std::string_view address) const noexcept {
  if (!words_) return false;
  const int i = words_->find(address);
  return i >= 0 && words_->is_rotary(i);
}

bool MachineAxes::is_endless(std::string_view address) const noexcept {
  return is_rotary(address) &&
         model_.joints[static_cast<std::size_t>(words_->find(address))].is_endless;
}

std::size_t MachineAxes::rotary_count() const noexcept {
  std::size_t count = 0;
  for (int i = 0; words_ && i < words_->count(); ++i) count += words_->is_rotary(i) ? 1 : 0;
  return count;
}

JointVector MachineAxes::joints(const std::vector<RotaryAt>& rotary) const {
  JointVector q{};
  if (!words_) return q;
  for (const RotaryAt& at : rotary) {
    const int i = words_->find(at.address);
    if (i >= 0 && at.deg) q[i] = words_->axis(i, *at.deg);
  }
  return q;
}

Vector3 MachineAxes::axis(const std::vector<RotaryAt>& rotary) const {
  return forward(model_, model_.tool_length_mm, joints(rotary)).axis.normalized();
}

std::optional<Eigen::Matrix3d> MachineAxes::linear_axes(const std::vector<RotaryAt>& rotary) const {
  Eigen::Matrix3d out;
  if (!words_) return std::nullopt;
  const auto tip_by_joint = jacobian(model_, model_.tool_length_mm, joints(rotary));
  constexpr std::array<std::string_view, 3> kAxes = {"X", "Y", "Z"};
  for (std::size_t k = 0; k < kAxes.size(); ++k) {
    const int i = words_->find(kAxes[k]);
    if (i < 0 || words_->is_rotary(i)) return std::nullopt;
    out.col(static_cast<Eigen::Index>(k)) = words_->sign(i) * tip_by_joint.col(i).head<3>();
  }
  return out;
}

/// Of all solutions the one whose rotary joints are nearest to `near`.
std::optional<JointVector> MachineAxes::solve_near(const ToolPose& pose, double tool_length_mm,
                                                   const JointVector& near) const {
  std::optional<JointVector> best;
  double min = std::numeric_limits<double>::infinity();
  for (int branch = 0; branch < branch_count(model_); ++branch) {
    const auto solution = meridian::solve(model_, tool_length_mm,
                                          Pose<double>{{pose.tip[0], pose.tip[1], pose.tip[2]},
                                                       {pose.axis[0], pose.axis[1], pose.axis[2]}},
                                          branch, near);
    if (solution.status == SolveStatus::kUnreachable) continue;
    double turn = 0;
    for (int i = 0; i < model_.joint_count; ++i) {
      if (words_->is_rotary(i)) turn += std::abs(solution.q[i] - near[i]);
    }
    if (turn < min) best = solution.q;
    min = std::min(min, turn);
  }
  return best;
}

Expected<double, cl::Refusal> MachineAxes::length_mm(std::optional<std::uint32_t> tool) const {
  if (!words_) return refuse(refusal_, kRightMachine);
  if (!tool) return model_.tool_length_mm;
  const Tool* const row = tools_.find(static_cast<int>(*tool));
  if (row != nullptr) return row->tip_length_mm();
  return refuse("a move to a place of the machine needs the length of tool " +
                    std::to_string(*tool) + ", which is not in the tool table",
                "give --tools FILE or --unknown-tool-length MM");
}

Expected<double, cl::Refusal> MachineAxes::retract_travel(const ToolPose& from,
                                                          const std::vector<RotaryAt>& rotary,
                                                          std::optional<std::uint32_t> tool) const {
  const auto length = length_mm(tool);
  if (!length) return tl::make_unexpected(length.error());
  constexpr double kSameTurn_rad = 1e-9, kAtRest = 1e-9;
  const auto begin = solve_near(from, *length, joints(rotary));
  const auto end = begin ? solve_near({from.tip + from.axis, from.axis}, *length, *begin)
                         : std::optional<JointVector>();
  if (!end) return refuse(kBeyondReach, kPartSetUp);
  double travel = std::numeric_limits<double>::infinity();
  for (int i = 0; i < model_.joint_count; ++i) {
    const double step = (*end)[i] - (*begin)[i];
    if (words_->is_rotary(i)) {
      if (std::abs(step) < kSameTurn_rad) continue;
      return refuse("rotary axes of machine " + model_.name + " turn along the tool axis",
                    kMovesByCam);
    }
    if (std::abs(step) < kAtRest || model_.joints[i].is_endless) continue;
    const JointLimits& limits = model_.joints[i].limits;
    travel =
        std::min(travel, ((step > 0 ? limits.travel_max : limits.travel_min) - (*begin)[i]) / step);
  }
  if (!std::isfinite(travel))
    return refuse("no travel of machine " + model_.name + " ends there", kMovesByCam);
  return std::max(travel, 0.0);
}

double MachineAxes::joint_at(const Target& target, int i) const {
  if (target.value) return words_->axis(i, *target.value);
  return target.position != nullptr ? (*target.position)[static_cast<std::size_t>(i)]
                                    : model_.joints[i].home;
}

std::optional<double> MachineAxes::word_at(const Target& target) const {
  const int i = words_ ? words_->find(target.address) : -1;
  return i >= 0 ? std::optional(words_->value(i, joint_at(target, i))) : std::nullopt;
}

Expected<MachineAxes::Reached, cl::Refusal> MachineAxes::move(
    const ToolPose& from, const std::vector<RotaryAt>& rotary, std::optional<std::uint32_t> tool,
    const std::vector<Target>& targets) const {
  const auto length = length_mm(tool);
  if (!length) return tl::make_unexpected(length.error());
  auto q = solve_near(from, *length, joints(rotary));
  if (!q) return refuse(kBeyondReach, kPartSetUp);
  for (const Target& target : targets) {
    const int i = words_->find(target.address);
    if (i < 0) {
      return refuse("machine " + model_.name + " has no axis " + std::string(target.address),
                    kRightMachine);
    }
    (*q)[i] = joint_at(target, i);
  }
  Reached out;
  out.pose = forward(model_, *length, *q);
  for (int i = 0; i < words_->count(); ++i) {
    if (words_->is_rotary(i)) out.rotary.push_back({words_->address(i), words_->value(i, (*q)[i])});
  }
  return out;
}

}  // namespace meridian::nc
