// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/keep_out.hpp"
#include "meridian/kinematics/machine_model.hpp"

namespace meridian {

/// What an operator asks for of the soft limits.
enum class LimitsWord : std::uint8_t {
  kSet,      ///< shrinks the travel of one joint
  kClear,    ///< gives one joint, or all of them, the travel of the machine file again
  kKeepOut,  ///< puts up a keep-out box, in place of the one of that name
  kOpen      ///< takes away the keep-out box of a name, or all of them where it is empty
};

/// A word with what it says: `kClear` looks at the joint alone, `kKeepOut` at the box, `kOpen` at
/// its name.
struct LimitsOrder {
  static constexpr std::uint8_t kAllJoints = 0xFF;

  LimitsWord word = LimitsWord::kSet;
  std::uint8_t joint = kAllJoints;  ///< machine order; `kClear`: kAllJoints too
  double min = 0, max = 0;          ///< mm or rad
  KeepOutBox box{};
  [[nodiscard]] bool operator==(const LimitsOrder&) const = default;
};

/// Why a word is not done.
enum class LimitsFault : std::uint8_t {
  kNone,
  kWord,      ///< no such word
  kJoint,     ///< the machine has no such joint
  kEndless,   ///< the joint has no travel that could shrink
  kValue,     ///< not the minimum below the maximum
  kTravel,    ///< beyond the travel of the machine file
  kBox,       ///< no keep-out box: without a name or a joint, or a minimum not below its maximum
  kBoxJoint,  ///< of a joint that the machine has not, or that has no travel
  kOwnBox,    ///< the machine file has a box of that name
  kNoBox,     ///< no box of that name was put up
  kBoxes      ///< there is no room for another box
};

/// Travel of joints that shrinks for a job: the soft limits, one pair for a joint at most, and
/// keep-out boxes. Plain data of fixed size. Units: mm or rad.
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
  [[nodiscard]] const KeepOut& keep_out() const noexcept { return keep_out_; }
  [[nodiscard]] bool empty() const noexcept {
    return rows_ == std::array<Row, kMaxJoints>{} && keep_out_.empty();
  }

  /// Does what `order` says on a machine with the travel of `own`, or nothing and says why.
  [[nodiscard]] LimitsFault apply(const LimitsOrder& order, const MachineModel& own) noexcept {
    if (order.word > LimitsWord::kOpen) return LimitsFault::kWord;
    if (order.word == LimitsWord::kKeepOut) return put_up(order.box, own);
    if (order.word == LimitsWord::kOpen) return open(order.box);
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

  /// Puts up a box as it is, whatever the machine; false where there is no room.
  bool put(const KeepOutBox& box) noexcept { return keep_out_.add(box); }

  /// What stands in the way of these on a machine with the travel of `own`.
  [[nodiscard]] LimitsFault find_fault(const MachineModel& own) const noexcept {
    for (std::size_t joint = 0; joint < rows_.size(); ++joint) {
      if (!rows_[joint].is_set) continue;
      const LimitsFault fault = find_fault(rows_[joint], own, joint);
      if (fault != LimitsFault::kNone) return fault;
    }
    for (const KeepOutBox& box : keep_out_.boxes()) {
      const LimitsFault fault = find_fault(box, own);
      if (fault != LimitsFault::kNone) return fault;
    }
    const std::size_t boxes = keep_out_.boxes().size() + own.keep_out.boxes().size();
    return boxes > std::size_t{KeepOut::kMax} ? LimitsFault::kBoxes : LimitsFault::kNone;
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

  [[nodiscard]] static LimitsFault find_fault(const KeepOutBox& box,
                                              const MachineModel& own) noexcept {
    if (box.name.front() == '\0' || box.name.back() != '\0' || box.joints == 0) {
      return LimitsFault::kBox;
    }
    if (box.joints >> static_cast<unsigned>(own.joint_count) != 0) return LimitsFault::kBoxJoint;
    for (int i = 0; i < own.joint_count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      if (!box.has(i)) continue;
      if (own.joints[n].is_endless) return LimitsFault::kBoxJoint;
      const bool is_right = std::abs(box.min[n]) < kFarthest && std::abs(box.max[n]) < kFarthest &&
                            box.min[n] < box.max[n];
      if (!is_right) return LimitsFault::kBox;
    }
    return own.keep_out.find(box) != nullptr ? LimitsFault::kOwnBox : LimitsFault::kNone;
  }

  [[nodiscard]] LimitsFault put_up(const KeepOutBox& box, const MachineModel& own) noexcept {
    const LimitsFault fault = find_fault(box, own);
    if (fault != LimitsFault::kNone) return fault;
    KeepOut next = keep_out_;
    (void)next.remove(box);
    const std::size_t boxes = next.boxes().size() + own.keep_out.boxes().size();
    if (boxes >= std::size_t{KeepOut::kMax} || !next.add(box)) return LimitsFault::kBoxes;
    keep_out_ = next;
    return LimitsFault::kNone;
  }

  [[nodiscard]] LimitsFault open(const KeepOutBox& named) noexcept {
    if (named.name.front() != '\0') {
      return keep_out_.remove(named) ? LimitsFault::kNone : LimitsFault::kNoBox;
    }
    keep_out_ = {};
    return LimitsFault::kNone;
  }

  static constexpr double kFarthest = 1e6;  // mm or rad; far beyond any travel

  std::array<Row, kMaxJoints> rows_{};
  KeepOut keep_out_{};
};

static_assert(std::is_trivially_copyable_v<SoftLimits> &&
              std::is_trivially_copyable_v<LimitsOrder>);

/// The travel that every joint of `own` with travel has under `limits`: of each a pair is set, and
/// the boxes of both are put up.
[[nodiscard]] inline SoftLimits travel_under(const SoftLimits& limits,
                                             const MachineModel& own) noexcept {
  SoftLimits travel;
  for (const KeepOut* const boxes : {&own.keep_out, &limits.keep_out()}) {
    for (const KeepOutBox& box : boxes->boxes()) (void)travel.put(box);
  }
  for (std::size_t joint = 0; joint < static_cast<std::size_t>(own.joint_count); ++joint) {
    const JointLimits& whole = own.joints[joint].limits;
    const SoftLimits::Row& row = limits.rows()[joint];
    if (own.joints[joint].is_endless) continue;
    travel.put(joint, row.is_set ? row.min : whole.travel_min,
               row.is_set ? row.max : whole.travel_max);
  }
  return travel;
}

/// Shrinks the travel of `model` to `limits`, as travel_under() gives them. The planner, the guard,
/// jogging and every check go by the travel and the boxes of their model, so that these limits are
/// checked wherever travel is. RT: cycle.
inline void shrink_travel(MachineModel& model, const SoftLimits& limits) noexcept {
  model.keep_out = limits.keep_out();
  for (std::size_t joint = 0; joint < limits.rows().size(); ++joint) {
    const SoftLimits::Row& row = limits.rows()[joint];
    if (!row.is_set) continue;
    model.joints[joint].limits.travel_min = row.min;
    model.joints[joint].limits.travel_max = row.max;
  }
}

}  // namespace meridian
