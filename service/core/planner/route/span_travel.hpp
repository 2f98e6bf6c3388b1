// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/planner/rewind.hpp"
#include "service/core/planner/feed/cells/joint_span.hpp"

namespace meridian {

/// Follows the joints over the spans of a smooth path and says where one would leave its travel
/// that a rewind may keep inside: at nine points of every span or more, so that no turn is missed.
/// The redundant joint is kept by another winding. What it may do between two points counts as
/// well, by how much its slope changes there:
///
///     margin = 10⁻⁴ rad + ½ max |c'ᵢ - c'ᵢ₋₁| hᵢ
///
/// which is twice what a smooth c(x) passes its samples by, h²|c''|/8 with c'' of neighbouring
/// slopes. Any other joint or drive is kept by the other branch: it counts at the points alone, and
/// where that branch has travel. The machine has a redundant joint. Units: mm, rad. Fixed store.
/// Context: planner thread. Source: docs/motion.md, section 11.
class SpanTravel {
 public:
  explicit SpanTravel(const MachineModel& model) noexcept : model_(model) {}

  /// The path starts at `joints`.
  void begin(const JointVector& joints, double tool_length_mm) noexcept {
    at_ = joints;
    tool_length_mm_ = tool_length_mm;
  }

  /// Follows the next span to its end. A value: a joint would leave its travel there, and nothing
  /// is followed.
  [[nodiscard]] std::optional<TravelEnd> follow(const JointSpan& span) noexcept;

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
    TravelEnd outside;         ///< the first, at the points looked at; no joint: all are inside
    double outside_x = 0;      ///< of the span, there
    JointVector outside_at{};  ///< the joints there
    bool is_there = true;      ///< a pose out of reach ends the walk

    [[nodiscard]] bool is_inside() const noexcept { return outside.joint < 0; }
  };
  /// The joints at the begin, the redundant joint turned by `by`.
  [[nodiscard]] JointVector turned(double by) const noexcept;
  /// From `joints`; a driven redundant joint is turned by `by`.
  [[nodiscard]] Walk walk(const JointSpan& span, const JointVector& joints,
                          double by) const noexcept;
  /// Notes the first joint outside, at `x` of the span.
  void note_outside(double x, const JointVector& joints, Walk& walked) const noexcept;
  /// Where the redundant joint leaves its travel.
  [[nodiscard]] std::optional<TravelEnd> find_outside(const Walk& walked) const noexcept;
  /// Whether the other branch is inside travel where a joint but the redundant one leaves it.
  [[nodiscard]] bool is_other_branch_inside(const JointSpan& span,
                                            const Walk& walked) const noexcept;

  const MachineModel& model_;
  JointVector at_{};
  double tool_length_mm_ = 0;
};

}  // namespace meridian
