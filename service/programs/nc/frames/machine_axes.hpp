// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/programs/cl/refusal.hpp"
#include "service/programs/nc/modes.hpp"
#include "service/programs/post/axis_words.hpp"

namespace meridian::nc {

/// What the axis words of an NC program do on one machine: the inverse of what
/// service/programs/post writes.
class MachineAxes {
 public:
  MachineAxes(const MachineModel& model, const ToolTable& tools);

  /// Why axis words of this machine cannot be read; empty: they can.
  [[nodiscard]] const std::string& refusal() const noexcept { return refusal_; }
  /// Whether `address` is that of a rotary axis.
  [[nodiscard]] bool is_rotary(std::string_view address) const noexcept;
  /// Whether it is that of an axis that turns without end.
  [[nodiscard]] bool is_endless(std::string_view address) const noexcept;

  /// How many rotary axes the machine has.
  [[nodiscard]] std::size_t rotary_count() const noexcept;

  /// Tool axis in W with the rotary axes there; those that are not given stand at zero.
  [[nodiscard]] Vector3 axis(const std::vector<RotaryAt>& rotary) const;
  /// Where X, Y and Z of the machine lead in W with the rotary axes there, as columns; nothing: it
  /// has no such axes.
  [[nodiscard]] std::optional<Eigen::Matrix3d> linear_axes(
      const std::vector<RotaryAt>& rotary) const;
  /// How far the tool axis of a block may lie from where evenly turning joints put it.
  [[nodiscard]] double axis_tolerance_rad() const noexcept { return model_.tolerances.axis_rad; }

  /// Axes of W, seen along the machine's: program coordinates are `to_program() * w`.
  [[nodiscard]] const Eigen::Matrix3d& to_program() const noexcept { return model_.X_MW.rotation; }

  /// Where the zero of the station's frame lies in the frame of the kinematics.
  [[nodiscard]] const Vector3& zero_mm() const noexcept { return model_.X_MW.origin_mm; }

  /// One axis of a move to the machine's own places.
  struct Target {
    std::string_view address;
    std::optional<double> value;  ///< mm or deg as the word says it; nothing: home
    const std::vector<double>* position = nullptr;  ///< where its joint goes then; null: home
  };
  /// What the program's word says once that axis is there; nothing: the machine has none.
  [[nodiscard]] std::optional<double> word_at(const Target& target) const;
  /// Where the tool comes from `from` when these axes go there, and rotary words with it.
  struct Reached {
    ToolPose pose{Vector3::Zero(), Vector3::UnitZ()};
    std::vector<RotaryAt> rotary;
  };
  [[nodiscard]] Expected<Reached, cl::Refusal> move(const ToolPose& from,
                                                    const std::vector<RotaryAt>& rotary,
                                                    std::optional<std::uint32_t> tool,
                                                    const std::vector<Target>& targets) const;

  /// How far the tool can leave `from` along its axis until a linear joint is at the end of its
  /// travel, mm. Refused where rotary joints would turn on the way.
  [[nodiscard]] Expected<double, cl::Refusal> retract_travel(
      const ToolPose& from, const std::vector<RotaryAt>& rotary,
      std::optional<std::uint32_t> tool) const;

 private:
  [[nodiscard]] Expected<double, cl::Refusal> length_mm(std::optional<std::uint32_t> tool) const;
  [[nodiscard]] JointVector joints(const std::vector<RotaryAt>& rotary) const;
  [[nodiscard]] double joint_at(const Target& target, int i) const;
  [[nodiscard]] std::optional<JointVector> solve_near(const ToolPose& pose, double tool_length_mm,
                                                      const JointVector& near) const;

  MachineModel model_;
  ToolTable tools_;
  std::optional<post::AxisWords> words_;
  std::string refusal_;
};

}  // namespace meridian::nc
