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
#include "meridian/kinematics/tip_box.hpp"

namespace meridian {

/// What an operator asks for of the soft limits.
enum class LimitsWord : std::uint8_t {
  kSet,      ///< shrinks the travel of one joint
  kClear,    ///< gives one joint the travel of the machine file again; all of them, and the tip
  kKeepOut,  ///< puts up a keep-out box, in place of the one of that name
  kOpen,     ///< takes away the keep-out box of a name, or all of them where it is empty
  kTip,      ///< sets the tip box
  kClearTip  ///< gives the tip the box of the machine file again, if that has one
};

/// A word with what it says: `kClear` looks at the joint alone, `kKeepOut` at the box, `kOpen` at
/// its name, `kTip` at its ends, of which the first three are X, Y, Z of the tip over the base.
struct LimitsOrder {
  static constexpr std::uint8_t kAllJoints = 0xFF;

  LimitsWord word = LimitsWord::kSet;
  std::uint8_t joint = kAllJoints;  ///< machine order; `kClear`: kAllJoints too
  double min = 0, max = 0;          ///< mm or rad
  KeepOutBox box{};
  [[nodiscard]] bool operator==(const LimitsOrder&) const = default;

  [[nodiscard]] TipBox tip_box() const noexcept {
    return {true, {box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}};
  }
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
  kBoxes,     ///< there is no room for another box
  kTip,       ///< no tip box: not the minimum below the maximum along each axis
  kTipBeyond  ///< a tip box beyond the one of the machine file
};

/// Travel of joints that shrinks for a job: the soft limits, one pair for a joint at most, keep-out
/// boxes, and a box of the tip. Plain data of fixed size. Units: mm or rad.
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
  [[nodiscard]] const TipBox& tip_box() const noexcept { return tip_box_; }
  [[nodiscard]] bool empty() const noexcept {
    return rows_ == std::array<Row, kMaxJoints>{} && keep_out_.empty() && !tip_box_.is_set;
  }

  /// Does what `order` says on a machine with the travel of `own`, or nothing and says why.
  [[nodiscard]] LimitsFault apply(const LimitsOrder& order, const MachineModel& own) noexcept {
    if (order.word > LimitsWord::kClearTip) return LimitsFault::kWord;
    if (order.word == LimitsWord::kKeepOut) return put_up(order.box, own);
    if (order.word == LimitsWord::kOpen) return open(order.box);
    if (order.word == LimitsWord::kTip) return set_tip_box(order.tip_box(), own);
    if (order.word == LimitsWord::kClearTip) return set_tip_box({}, own);
    const bool is_clear = order.word == LimitsWord::kClear;
    if (is_clear && order.joint == LimitsOrder::kAllJoints) {
      rows_ = {};
      tip_box_ = {};
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

  /// Sets the tip box as it is, whatever the machine.
  void put(const TipBox& box) noexcept { tip_box_ = box; }

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
    if (boxes > std::size_t{KeepOut::kMax}) return LimitsFault::kBoxes;
    return find_fault(tip_box_, own);
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

  [[nodiscard]] static LimitsFault find_fault(const TipBox& box, const MachineModel& own) noexcept {
    if (!box.is_set) return LimitsFault::kNone;
    if (!is_tip_box(box)) return LimitsFault::kTip;
    return is_within(box, own.tip_box) ? LimitsFault::kNone : LimitsFault::kTipBeyond;
  }

  [[nodiscard]] LimitsFault set_tip_box(const TipBox& box, const MachineModel& own) noexcept {
    const LimitsFault fault = find_fault(box, own);
    if (fault == LimitsFault::kNone) tip_box_ = box;
    return fault;
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
  TipBox tip_box_{};
};

static_assert(std::is_trivially_copyable_v<SoftLimits> &&
              std::is_trivially_copyable_v<LimitsOrder>);

/// The travel that every joint of `own` with travel has under `limits`: of each a pair is set, the
/// keep-out boxes of both are put up, and the tip has the box of `limits`, or else that of `own`.
[[nodiscard]] inline SoftLimits travel_under(const SoftLimits& limits,
                                             const MachineModel& own) noexcept {
  SoftLimits travel;
  travel.put(limits.tip_box().is_set ? limits.tip_box() : own.tip_box);
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
  model.tip_box = limits.tip_box();
  for (std::size_t joint = 0; joint < limits.rows().size(); ++joint) {
    const SoftLimits::Row& row = limits.rows()[joint];
    if (!row.is_set) continue;
    model.joints[joint].limits.travel_min = row.min;
    model.joints[joint].limits.travel_max = row.max;
  }
}

}  // namespace meridian
