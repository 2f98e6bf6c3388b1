// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "meridian/kinematics/machine_model.hpp"
#include "service/core/planner/feed/joint_span.hpp"

namespace meridian {

/// Follows the joints over the spans of a smooth path and tells where the redundant joint would
/// leave its travel: at nine places of every span or more, so that no turn is missed. What it may
/// do between two places counts as well, by how much its slope changes there:
///
///     margin = 10⁻⁴ rad + ½ max |c'ᵢ - c'ᵢ₋₁| hᵢ
///
/// which is twice what a smooth c(x) passes its samples by, h²|c''|/8 with c'' of neighbouring
/// slopes. The machine has a redundant joint with travel. Units: mm, rad. Fixed store. Context:
/// planner thread. Source: docs/motion.md, section 11.
class FreeTravel {
 public:
  explicit FreeTravel(const MachineModel& model) noexcept : model_(model) {}

  /// The path starts at `joints`.
  void begin(const JointVector& joints, double tool_length_mm) noexcept {
    at_ = joints;
    tool_length_mm_ = tool_length_mm;
  }

  /// Follows the next span to its end. A value: the redundant joint would come to it, outside its
  /// travel, and nothing is followed.
  [[nodiscard]] std::optional<double> follow(const JointSpan& span) noexcept;

  /// Whether the next span keeps every joint and drive inside travel with the redundant joint
  /// turned by `by` before.
  [[nodiscard]] bool fits(const JointSpan& span, double by) const noexcept;

  /// The joints at the end of the next span, the redundant joint turned by `by` before.
  [[nodiscard]] JointVector end_of(const JointSpan& span, double by) const noexcept {
    return walk(span, turned(by), by).end;
  }

  /// The same on another branch, that of `span`, from `joints` at its begin. It is not driven.
  [[nodiscard]] bool fits_from(const JointVector& joints, const JointSpan& span) const noexcept;
  [[nodiscard]] JointVector end_from(const JointVector& joints,
                                     const JointSpan& span) const noexcept {
    return walk(span, joints, 0).end;
  }

 private:
  struct Walk {
    JointVector end{};
    double begin = 0, low = 0, high = 0, margin = 0;  ///< of the redundant joint
    bool is_inside = true;                            ///< all joints, at the places looked at
    bool is_there = true;                             ///< a pose out of reach ends the walk
  };
  /// The joints at the begin, the redundant joint turned by `by`.
  [[nodiscard]] JointVector turned(double by) const noexcept;
  /// From `joints`; a driven redundant joint is turned by `by`.
  [[nodiscard]] Walk walk(const JointSpan& span, const JointVector& joints,
                          double by) const noexcept;
  [[nodiscard]] std::optional<double> find_outside(const Walk& walked) const noexcept;

  const MachineModel& model_;
  JointVector at_{};
  double tool_length_mm_ = 0;
};

}  // namespace meridian
