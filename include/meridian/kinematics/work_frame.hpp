// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "meridian/geometry/vector3.hpp"

namespace meridian {

/// Characters of a work frame's name.
inline constexpr std::size_t kFrameNameChars = 23;

/// Where a workpiece lies, in the frame of the kinematics, under a number: what G54 and its kin are
/// on other controls. Number 0 is the frame of the machine file and stands in no table.
struct WorkFrame {
  std::uint8_t number = 0;
  std::array<char, kFrameNameChars + 1> name{};  ///< zero-terminated, may be empty
  Array3 origin_mm{};
  Array3 rotation_deg{};  ///< a, b, c: Rz(c) Ry(b) Rx(a)
  [[nodiscard]] bool operator==(const WorkFrame&) const = default;
};

/// What an operator asks for of the table.
enum class FrameWord : std::uint8_t {
  kSet,     ///< puts the frame into its row; where that is the active one it is in force
  kSelect,  ///< makes the row with this number the active one; 0: the machine file's
  kClear    ///< empties the row, which must not be the active one
};

/// A word with its row: `kSelect` and `kClear` look at the number alone.
struct FrameOrder {
  FrameWord word = FrameWord::kSet;
  WorkFrame frame{};
  [[nodiscard]] bool operator==(const FrameOrder&) const = default;
};

/// Why a word is not done.
enum class FrameFault : std::uint8_t {
  kNone,
  kWord,     ///< no such word
  kNumber,   ///< `kSet`: 1 to WorkFrames::kMax
  kValue,    ///< not finite, beyond 1e5 mm or 360 degrees
  kNotSet,   ///< no frame stands under this number
  kIsActive  ///< it is in force: select another one first
};

/// The numbered table of a machine, one of its rows active; plain data of fixed size. The numbers
/// are 1 to 54: as many as G54 to G59 and G54.1 P1 to P48 together.
/// Proof: tests/unit/kinematics/work_frame_test.cpp.
class WorkFrames {
 public:
  static constexpr int kMax = 54;
  static constexpr double kMax_mm = 1e5, kMax_deg = 360;

  /// The rows by their numbers.
  [[nodiscard]] std::span<const WorkFrame> rows() const noexcept { return {rows_.data(), count_}; }
  /// Number of the active one; 0: the machine file's.
  [[nodiscard]] int active() const noexcept { return active_; }
  [[nodiscard]] const WorkFrame* find(int number) const noexcept {
    const auto at = std::find_if(rows().begin(), rows().end(),
                                 [number](const WorkFrame& row) { return row.number == number; });
    return at != rows().end() ? &*at : nullptr;
  }

  /// Does what `order` says, or nothing and says why.
  [[nodiscard]] FrameFault apply(const FrameOrder& order) noexcept {
    const int number = order.frame.number;
    switch (order.word) {
      case FrameWord::kSet:
        return put(order.frame);
      case FrameWord::kSelect:
        if (number != 0 && find(number) == nullptr) return FrameFault::kNotSet;
        active_ = number;
        return FrameFault::kNone;
      case FrameWord::kClear:
        if (find(number) == nullptr) return FrameFault::kNotSet;
        if (number == active_) return FrameFault::kIsActive;
        count_ = static_cast<std::size_t>(
            std::remove_if(begin(), end(),
                           [number](const WorkFrame& row) { return row.number == number; }) -
            begin());
        return FrameFault::kNone;
    }
    return FrameFault::kWord;
  }

  [[nodiscard]] bool operator==(const WorkFrames& other) const noexcept {
    return active_ == other.active_ && std::ranges::equal(rows(), other.rows());
  }

 private:
  [[nodiscard]] WorkFrame* begin() noexcept { return rows_.data(); }
  [[nodiscard]] WorkFrame* end() noexcept { return rows_.data() + count_; }

  [[nodiscard]] static bool is_within(const Array3& values, double max) noexcept {
    return std::all_of(values.begin(), values.end(),
                       [max](double value) { return std::abs(value) <= max; });
  }

  [[nodiscard]] FrameFault put(const WorkFrame& frame) noexcept {
    if (frame.number < 1 || frame.number > kMax) return FrameFault::kNumber;
    if (!is_within(frame.origin_mm, kMax_mm) || !is_within(frame.rotation_deg, kMax_deg)) {
      return FrameFault::kValue;
    }
    WorkFrame* const at = std::find_if(
        begin(), end(), [&frame](const WorkFrame& row) { return row.number >= frame.number; });
    if (at == end() || at->number != frame.number) {
      ++count_;  // there is a place for every number
      std::move_backward(at, end() - 1, end());
    }
    *at = frame;
    at->name.back() = '\0';
    return FrameFault::kNone;
  }

  std::array<WorkFrame, kMax> rows_{};
  std::size_t count_ = 0;
  int active_ = 0;
};

static_assert(std::is_trivially_copyable_v<WorkFrames> && std::is_trivially_copyable_v<FrameOrder>);

}  // namespace meridian
