// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <span>

#include "meridian/kinematics/limited.hpp"
#include "meridian/path/path_piece.hpp"

/// What the joints do along a path, cell by cell: bounds of their derivatives by the path length,
/// and whether they stay inside travel and reach. Units: mm, rad, s.
namespace meridian {

inline constexpr double kTravelMargin = 1e-9;  ///< rounding of a travel end that is reached exactly
/// Of a tolerance, for what is found at samples: they are not everywhere.
inline constexpr double kSampledShare = 0.998;
/// Rounding of a component of the tool axis.
inline constexpr double kAxisNoise = 0.5 * std::numeric_limits<double>::epsilon();
/// Jerk that 1 rad of noise shows as: a third difference weighs four setpoints by 1, 3, 3, 1.
[[nodiscard]] constexpr double noise_gain(double cycle_s) noexcept {
  return 8 / (cycle_s * cycle_s * cycle_s);
}

/// Bounds of |dq/ds|, |d²q/ds²|, |d³q/ds³| of everything that has limits on a short stretch of
/// path: the joints, then the drives of the stage.
struct JointCell {
  double begin = 0, end = 0;  ///< s
  double share_rate = 0;      ///< bound of dx/ds, x the share of tip and axis (fraction_at)
  double noise_rad = 0;       ///< rounding of the redundant joint beside the pole
  LimitedVector d1{}, d2{}, d3{};
};

/// Why joints cannot follow a path. kJump: or only next to standstill. kKeepOut: `value` is the
/// number of the box. kTipBox: `joint` is the axis of the base, 0 to 2, `value` where, mm.
struct PathFault {
  enum class Kind {
    kNone,
    kTravel,
    kUnreachable,
    kTooLong,
    kBranch,
    kJump,
    kKeepOut,
    kTipBox
  } kind = Kind::kNone;
  int joint = -1;  ///< place in limited.hpp; -1: none
  double value = 0;
};

[[nodiscard]] inline bool is_fault(const PathFault& fault) noexcept {
  return fault.kind != PathFault::Kind::kNone;
}

/// Cells of one path, in order, in a fixed store.
class CellTable {
 public:
  static constexpr int kCapacity = 1024;

  void clear() noexcept { count_ = 0; }
  /// Forgets the cells from `first` on.
  void go_back(int first) noexcept { count_ = first; }
  [[nodiscard]] int size() const noexcept { return count_; }
  [[nodiscard]] std::span<const JointCell> range(int first, int last) const noexcept {
    return {cells_.data() + first, static_cast<std::size_t>(last - first)};
  }
  [[nodiscard]] std::span<const JointCell> all() const noexcept { return range(0, count_); }

  /// How much slower than its easiest place a cell looks at worst: the largest ratio of the
  /// acceleration along the path that the joints allow at a sample to the one that the bounds of
  /// its cell allow, of the last append().
  [[nodiscard]] double coarseness() const noexcept { return coarseness_; }

  /// Appends `cells` equal cells of `piece` from `begin` to `end` and checks the joints on the way,
  /// extremes between the samples included. `joints` are those at `begin` (within half a turn) and
  /// become those at `end`. Nothing may be read after a fault.
  [[nodiscard]] PathFault append(const MachineModel& model, const PathPiece& piece, double begin,
                                 double end, int cells, JointVector& joints) noexcept;

 private:
  std::array<JointCell, kCapacity> cells_;
  int count_ = 0;
  double coarseness_ = 1;
};

/// Travel at the turning points that joints and drives have between two samples `h` apart, by the
/// cubic through both: values `a` and `b`, derivatives `da` and `db`.
[[nodiscard]] PathFault check_turns(const MachineModel& model, const LimitedVector& a,
                                    const LimitedVector& da, const LimitedVector& b,
                                    const LimitedVector& db, double h) noexcept;

/// Value and derivatives of everything that has limits at one place of a path.
struct JointDerivatives {
  const LimitedVector &q, &d1, &d2, &d3;
};

/// Whether joints go from `a` to `b`, `h` apart, as their derivatives there say. At an inner
/// singularity they may not: a joint of a robot without a direction of its own keeps the value it
/// came with there, and beside it turns at once, by half a turn where the path goes straight
/// through; slides that come to lie in one plane leave on one side for ever and come back from the
/// other. Machines that have none pass: their one singular place is the pole, which the path is
/// cut for.
[[nodiscard]] PathFault check_joins(const MachineModel& model, const JointDerivatives& a,
                                    const JointDerivatives& b, double h) noexcept;

/// Whether joints stay out of every keep-out box from `a` to `b`, `h` apart: they are no farther
/// beside the straight line between both than h²/8 times their second derivative there.
[[nodiscard]] PathFault check_keep_out(const MachineModel& model, const JointDerivatives& a,
                                       const JointDerivatives& b, double h) noexcept;

/// Whether the tip stays inside of its box from `a` to `b`, `h` apart.
[[nodiscard]] PathFault check_tip_box(const MachineModel& model, double tool_length_mm,
                                      const JointDerivatives& a, const JointDerivatives& b,
                                      double h) noexcept;

/// check_keep_out() and check_tip_box(), for a machine that has one of them.
[[nodiscard]] PathFault check_boxes(const MachineModel& model, double tool_length_mm,
                                    const JointDerivatives& a, const JointDerivatives& b,
                                    double h) noexcept;
/// Whether there is anything for check_boxes() to look at.
[[nodiscard]] inline bool has_boxes(const MachineModel& model) noexcept {
  return !model.keep_out.empty() || model.tip_box.is_set;
}

/// One cell that bounds both.
[[nodiscard]] JointCell merged(const JointCell& a, const JointCell& b) noexcept;

}  // namespace meridian
