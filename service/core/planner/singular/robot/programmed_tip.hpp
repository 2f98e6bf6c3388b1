// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "meridian/geometry/vector3.hpp"

namespace meridian {

/// The tool tip that was programmed, as a function of the path parameter u: straight between the
/// ends of blocks. Fixed store: what is too long ago is forgotten. Units: mm. Frame: W. Proof:
/// tests/unit/planner/programmed_tip_test.cpp.
class ProgrammedTip {
 public:
  static constexpr int kCapacity = 32768;

  /// `is_used`: false where nothing will be added, which then has no store.
  explicit ProgrammedTip(bool is_used) : marks_(is_used ? kCapacity : 1) {}

  /// Starts with `tip` at u = 0.
  void begin(const Vector3& tip) noexcept;
  /// The tip at the end of a block; `u` grows.
  void add(double u, const Vector3& tip) noexcept;

  /// Distance between `tip` and the programmed one at `u`; infinite where it is not known.
  [[nodiscard]] double distance_to(double u, const Vector3& tip) const noexcept;

 private:
  struct Mark {
    double u = 0;
    Array3 tip{};
  };
  [[nodiscard]] const Mark& mark(std::int64_t n) const noexcept {
    return marks_[static_cast<std::size_t>(n % kCapacity)];
  }

  std::vector<Mark> marks_;
  std::int64_t first_ = 0, last_ = 0;  ///< marks from first_ to last_ - 1
};

}  // namespace meridian
