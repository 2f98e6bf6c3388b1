// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "meridian/kinematics/joints.hpp"

/// Keep-out boxes of the joints: where a vice, a probe or a tailstock stands, in joint space.
/// Nothing here allocates or throws. Units: mm, rad. RT: cycle.
/// Proof: tests/unit/kinematics/keep_out_test.cpp.
namespace meridian {

/// Characters of a box's name.
inline constexpr std::size_t kKeepOutNameChars = 23;

/// Some joints, each with an interval. All of them inside at once is forbidden; the faces are
/// allowed. Joints that are not named may stand anywhere.
struct KeepOutBox {
  std::array<char, kKeepOutNameChars + 1> name{};  ///< zero-terminated
  std::uint32_t joints = 0;                        ///< mask, machine order; never 0
  JointVector min{}, max{};                        ///< of the joints of the mask
  [[nodiscard]] bool operator==(const KeepOutBox&) const = default;

  [[nodiscard]] bool has(int joint) const noexcept {
    return (joints >> static_cast<unsigned>(joint) & 1U) != 0;
  }
};

/// The boxes of a machine. Plain data of fixed size.
class KeepOut {
 public:
  static constexpr int kMax = 8;

  [[nodiscard]] std::span<const KeepOutBox> boxes() const noexcept {
    return {boxes_.data(), static_cast<std::size_t>(count_)};
  }
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }

  /// False where there is no room.
  bool add(const KeepOutBox& box) noexcept {
    if (count_ == kMax) return false;
    boxes_[static_cast<std::size_t>(count_++)] = box;
    return true;
  }

  /// The box of that name; nullptr: none has it.
  [[nodiscard]] const KeepOutBox* find(const KeepOutBox& named) const noexcept {
    const auto at = std::ranges::find(boxes(), named.name, &KeepOutBox::name);
    return at == boxes().end() ? nullptr : &*at;
  }

  /// Takes away the box of that name; false where none has it.
  bool remove(const KeepOutBox& named) noexcept {
    const KeepOutBox* const found = find(named);
    if (found == nullptr) return false;
    KeepOutBox* const at = boxes_.data() + (found - boxes_.data());
    std::move(at + 1, boxes_.data() + count_, at);
    boxes_[static_cast<std::size_t>(--count_)] = {};
    return true;
  }

  /// What box `number`, from 0, is called.
  [[nodiscard]] const char* name_of(double number) const noexcept {
    const bool is_one = number >= 0 && number < count_;
    return is_one ? boxes_[static_cast<std::size_t>(number)].name.data() : "?";
  }

  [[nodiscard]] bool operator==(const KeepOut& other) const noexcept {
    return std::ranges::equal(boxes(), other.boxes());
  }

 private:
  std::array<KeepOutBox, kMax> boxes_{};
  int count_ = 0;
};
static_assert(std::is_trivially_copyable_v<KeepOut>);

/// mm or rad; rounding of joints on the face of a box.
inline constexpr double kKeepOutRounding = 1e-9;

/// How deep `q` is inside `box`: the way to the nearest face; not positive outside.
[[nodiscard]] inline double depth_inside(const KeepOutBox& box, const JointVector& q) noexcept {
  double depth = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxJoints; ++i) {
    if (!box.has(i)) continue;
    const auto n = static_cast<std::size_t>(i);
    depth = std::min({depth, q[n] - box.min[n], box.max[n] - q[n]});
  }
  return depth;
}

/// The first box that `q` is inside of, deeper than `margin`; -1: none.
[[nodiscard]] inline int keep_out_at(const KeepOut& keep_out, const JointVector& q,
                                     double margin = kKeepOutRounding) noexcept {
  const auto boxes = keep_out.boxes();
  for (std::size_t n = 0; n < boxes.size(); ++n) {
    if (depth_inside(boxes[n], q) > margin) return static_cast<int>(n);
  }
  return -1;
}

/// Where joints enter a box on their way: its number, and at which share of the way; -1: none.
struct KeepOutEntry {
  int box = -1;
  double share = 1;
};

/// The share of the straight way from `a` to `b` at which it enters `box`, each joint being up to
/// `off` beside that way; above 1: it does not. Negative `off`: a box that is smaller by so much.
[[nodiscard]] inline double entry_share(const KeepOutBox& box, const JointVector& a,
                                        const JointVector& b, const JointVector& off) noexcept {
  constexpr double kNever = 2;
  double from = 0, to = 1;
  for (int i = 0; i < kMaxJoints; ++i) {
    if (!box.has(i)) continue;
    const auto n = static_cast<std::size_t>(i);
    const double low = box.min[n] - off[n] + kKeepOutRounding;
    const double high = box.max[n] + off[n] - kKeepOutRounding;
    const double by = b[n] - a[n];
    if (by == 0) {
      if (!(a[n] > low && a[n] < high)) return kNever;
      continue;
    }
    const double at_low = (low - a[n]) / by, at_high = (high - a[n]) / by;
    from = std::max(from, std::min(at_low, at_high));
    to = std::min(to, std::max(at_low, at_high));
    if (!(low < high) || !(from < to)) return kNever;
  }
  return from;
}

/// The first of the boxes that the way from `a` to `b` enters, as entry_share() says.
[[nodiscard]] inline KeepOutEntry keep_out_between(const KeepOut& keep_out, const JointVector& a,
                                                   const JointVector& b,
                                                   const JointVector& off = {}) noexcept {
  KeepOutEntry first;
  const auto boxes = keep_out.boxes();
  for (std::size_t n = 0; n < boxes.size(); ++n) {
    const double share = entry_share(boxes[n], a, b, off);
    if (share < first.share || (share <= 1 && first.box < 0)) {
      first = {static_cast<int>(n), share};
    }
  }
  return first;
}

/// Narrows [low, high], in which `joint` may go from where it is in `q` while the others stand
/// still, to what the boxes leave. From inside of a box the way is open to the nearer face alone.
/// Boxes of other joints than those in `known` say nothing.
inline void narrow_outside(const KeepOut& keep_out, const JointVector& q, int joint,
                           std::uint32_t known, double& low, double& high) noexcept {
  const auto j = static_cast<std::size_t>(joint);
  for (const KeepOutBox& box : keep_out.boxes()) {
    if (!box.has(joint) || (box.joints & known) != box.joints) continue;
    KeepOutBox others = box;
    others.joints &= ~(1U << static_cast<unsigned>(joint));
    if (!(depth_inside(others, q) > kKeepOutRounding)) continue;
    const double below = q[j] - box.min[j], above = box.max[j] - q[j];
    if (below <= kKeepOutRounding) {
      high = std::min(high, std::max(box.min[j], q[j]));
    } else if (above <= kKeepOutRounding) {
      low = std::max(low, std::min(box.max[j], q[j]));
    } else if (below < above) {
      high = std::min(high, q[j]);
    } else {
      low = std::max(low, q[j]);
    }
  }
}

}  // namespace meridian
