// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "meridian/geometry/vector3.hpp"

namespace meridian {

/// The tool axis that was programmed, as a function of the path parameter u: great circles between
/// the ends of blocks. Ends closer than kMinGap are merged, and the largest angle that hides is
/// told. Fixed store: what is too long ago is forgotten. Units: mm, rad. Frame: W.
class ProgrammedAxis {
 public:
  static constexpr int kCapacity = 32768;
  static constexpr double kMinGap_mm = 0.01;

  ProgrammedAxis() : ProgrammedAxis(true) {}
  /// `is_used`: false where nothing will be added, which then has no store.
  explicit ProgrammedAxis(bool is_used) : marks_(is_used ? kCapacity : 1) {}

  /// Starts with `axis` at u = 0.
  void begin(const Vector3& axis) noexcept;

  /// The axis at the end of a block; `u` grows.
  void add(double u, const Vector3& axis) noexcept;

  struct Known {
    Vector3 axis;
    double hidden_rad = 0;  ///< the largest angle that merging may hide there
  };
  /// The axis at `u`; nullopt where it is not known.
  [[nodiscard]] std::optional<Known> at(double u) const noexcept;

  /// Angle between `axis` and the programmed one at `u`, with what merging may hide; infinite where
  /// it is not known.
  [[nodiscard]] double angle_to(double u, const Vector3& axis) const noexcept;

  /// Where the next block behind `u` ends; infinite where none is known.
  [[nodiscard]] double next_end(double u) const noexcept;

  /// Where between `begin` and `end` its direction changes at once, ascending. Where `kinks` has no
  /// room for all: of as many parts of the path the sharpest each. Returns how many.
  std::size_t find_kinks(double begin, double end, std::span<double> kinks) const noexcept;

 private:
  struct Mark {
    double u = 0;
    Array3 axis{};
    double hidden_rad = 0;  ///< between the mark before and this one
  };
  std::size_t find_sharpest(double begin, double end, std::span<double> kinks) const noexcept;
  [[nodiscard]] const Mark& mark(std::int64_t n) const noexcept {
    return marks_[static_cast<std::size_t>(n % kCapacity)];
  }
  /// The newest mark at or ahead of `u`, as long as another one is behind it.
  [[nodiscard]] std::int64_t mark_before(double u) const noexcept;
  /// By how much the turn per u changes at the mark, rad/mm.
  [[nodiscard]] double kink_at(std::int64_t n) const noexcept;

  std::vector<Mark> marks_;
  std::int64_t first_ = 0, last_ = 0;  ///< marks from first_ to last_ - 1
};

}  // namespace meridian
