// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "service/core/planner/singular/pole/pole_walls.hpp"
#include "service/core/planner/singular/pole/pole_zone.hpp"

namespace meridian {

/// What the redundant joint is at an end of a spline, with `count` - 1 derivatives by u; 0:
/// anything.
struct FreeEnd {
  std::array<double, 3> of{};
  std::size_t count = 0;
};

/// The smooth course of the redundant joint through its corridor: a cubic spline by u.
///
///     ─┬──────────┬───┬─┬┬┬─┬───┬──────────┬─     knots: as close as the corridor is bent
///      every control value inside all windows that its curve has a part in, the string through
///      these windows pulled taut, then made rounder inside them: so the curve is inside the
///      corridor by construction
///
/// Two continuous derivatives. Fixed store. Units: mm, rad. Source: docs/motion.md, section 10.
class FreeSpline {
 public:
  static constexpr std::size_t kPieces = 512;

  FreeSpline();

  /// How far knots may be apart, and which share of the corridor's width a window has to keep.
  struct Shape {
    double max_gap_mm = 0;
    double width_share = 0;
    std::size_t bold = 0;  ///< knots at either end of what a control value bears on left out
    int sweeps = 0;        ///< of relaxation: the more the rounder, and the farther from the string
  };
  /// `windows`: of the nodes. False: too many pieces.
  [[nodiscard]] bool fit(const SpanLookup& spans, std::span<const PoleWalls::Node> nodes,
                         std::span<const StringWindow> windows, const FreeEnd& begin,
                         const FreeEnd& end, const Shape& shape) noexcept;

  [[nodiscard]] std::size_t size() const noexcept { return pieces_; }
  /// Range and values of piece `n`; the rest is left to the caller.
  [[nodiscard]] PoleZone piece(std::size_t n) const noexcept;

 private:
  static constexpr std::size_t kDegree = 3;
  static constexpr std::size_t kControls = kPieces + kDegree;

  /// Lets gaps grow from node to node no faster than the spline's shape stands.
  void grade(std::span<const PoleWalls::Node> nodes) noexcept;
  [[nodiscard]] bool set_knots(const SpanLookup& spans,
                               std::span<const PoleWalls::Node> nodes) noexcept;
  /// The windows of the control values; where one is too narrow gaps are made smaller. True: there
  /// was one.
  [[nodiscard]] bool narrow(std::span<const PoleWalls::Node> nodes,
                            std::span<const StringWindow> windows, const Shape& shape) noexcept;
  /// Makes control values between `first` and `last` rounder inside their windows: each in turn to
  /// where the squares of the second differences about it are least.
  void relax(std::size_t first, std::size_t last) noexcept;
  void fix_ends(const FreeEnd& begin, const FreeEnd& end) noexcept;

  std::vector<double> gaps_;  ///< per node
  std::vector<double> sums_;  ///< of gaps that fit in between the begin and a node
  std::vector<double> knots_;
  std::vector<double> controls_;
  std::vector<StringWindow> windows_;  ///< of the control values
  std::size_t pieces_ = 0;
  std::size_t fixed_at_begin_ = 0, fixed_at_end_ = 0;
};

}  // namespace meridian
