// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/machine_model.hpp"

namespace meridian {

/// What an operator asks for of the soft limits.
enum class LimitsWord : std::uint8_t {
  kSet,   ///< shrinks the travel of one joint
  kClear  ///< gives one joint, or all of them, the travel of the machine file again
};

/// A word with what it says: `kClear` looks at the joint alone.
struct LimitsOrder {
  static constexpr std::uint8_t kAllJoints = 0xFF;

  LimitsWord word = LimitsWord::kSet;
  std::uint8_t joint = kAllJoints;  ///< machine order; `kClear`: kAllJoints too
  double min = 0, max = 0;          ///< mm or rad
  [[nodiscard]] bool operator==(const LimitsOrder&) const = default;
};

/// Why a word is not done.
enum class LimitsFault : std::uint8_t {
  kNone,
  kWord,     ///< no such word
  kJoint,    ///< the machine has no such joint
  kEndless,  ///< the joint has no travel that could shrink
  kValue,    ///< not the minimum below the maximum
  kTravel    ///< beyond the travel of the machine file
};

/// Travel of joints that shrinks for a job: the soft limits, one pair for a joint at most. Plain
/// data of fixed size. Units: mm or rad.
/// Proof: tests/unit/kinematics/soft_limits_test.cpp.
class SoftLimits {
 public:
  struct Row {
    bool is_set = false;
    double min = 0, max = 0;
    [[nodiscard]] bool operator==(const Row&) const = default;
  };

  /// By joint, in machine order.
  [[nodiscard]] const std::array<Row, kMaxJoints>& rows() const noexcept { return rows_; }
  [[nodiscard]] bool empty() const noexcept { return rows_ == std::array<Row, kMaxJoints>{}; }

  /// Does what `order` says on a machine with the travel of `own`, or nothing and says why.
  [[nodiscard]] LimitsFault apply(const LimitsOrder& order, const MachineModel& own) noexcept {
    if (order.word > LimitsWord::kClear) return LimitsFault::kWord;
    const bool is_clear = order.word == LimitsWord::kClear;
    if (is_clear && order.joint == LimitsOrder::kAllJoints) {
      rows_ = {};
      return LimitsFault::kNone;
    }
    if (order.joint >= own.joint_count) return LimitsFault::kJoint;
    const Row row = is_clear ? Row{} : Row{true, order.min, order.max};
    const LimitsFault fault = is_clear ? LimitsFault::kNone : find_fault(row, own, order.joint);
    if (fault == LimitsFault::kNone) rows_[order.joint] = row;
    return fault;
  }

  /// Puts the pair of one joint as it is, whatever the machine; false where there is no such joint.
  bool put(std::size_t joint, double min, double max) noexcept {
    if (joint >= rows_.size()) return false;
    rows_[joint] = {true, min, max};
    return true;
  }

  /// What stands in the way of these on a machine with the travel of `own`.
  [[nodiscard]] LimitsFault find_fault(const MachineModel& own) const noexcept {
    for (std::size_t joint = 0; joint < rows_.size(); ++joint) {
      if (!rows_[joint].is_set) continue;
      const LimitsFault fault = find_fault(rows_[joint], own, joint);
      if (fault != LimitsFault::kNone) return fault;
    }
    return LimitsFault::kNone;
  }

  [[nodiscard]] bool operator==(const SoftLimits&) const = default;

 private:
  [[nodiscard]] static LimitsFault find_fault(const Row& row, const MachineModel& own,
                                              std::size_t joint) noexcept {
    if (joint >= static_cast<std::size_t>(own.joint_count)) return LimitsFault::kJoint;
    const JointSpec& spec = own.joints[joint];
    if (spec.is_endless) return LimitsFault::kEndless;
    if (!(row.min < row.max)) return LimitsFault::kValue;
    const bool is_inside = row.min >= spec.limits.travel_min && row.max <= spec.limits.travel_max;
    return is_inside ? LimitsFault::kNone : LimitsFault::kTravel;
  }

  std::array<Row, kMaxJoints> rows_{};
};

static_assert(std::is_trivially_copyable_v<SoftLimits> &&
              std::is_trivially_copyable_v<LimitsOrder>);

/// The travel that every joint of `own` with travel has under `limits`: of each a pair is set.
[[nodiscard]] inline SoftLimits travel_under(const SoftLimits& limits,
                                             const MachineModel& own) noexcept {
  SoftLimits travel;
  for (std::size_t joint = 0; joint < static_cast<std::size_t>(own.joint_count); ++joint) {
    const JointLimits& whole = own.joints[joint].limits;
    const SoftLimits::Row& row = limits.rows()[joint];
    if (own.joints[joint].is_endless) continue;
    travel.put(joint, row.is_set ? row.min : whole.travel_min,
               row.is_set ? row.max : whole.travel_max);
  }
  return travel;
}

/// Shrinks the travel of `model` to `limits`. The planner, the guard, jogging and every check go by
/// the travel of their model, so that these limits are checked wherever travel is. RT: cycle.
inline void shrink_travel(MachineModel& model, const SoftLimits& limits) noexcept {
  for (std::size_t joint = 0; joint < limits.rows().size(); ++joint) {
    const SoftLimits::Row& row = limits.rows()[joint];
    if (!row.is_set) continue;
    model.joints[joint].limits.travel_min = row.min;
    model.joints[joint].limits.travel_max = row.max;
  }
}

}  // namespace meridian
