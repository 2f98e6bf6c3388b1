// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "meridian/planner/profile.hpp"
#include "meridian/planner/time_piece.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/feed/legs/path_choice.hpp"

namespace meridian {

/// What a stop may use from each moment of a motion on: the limits of the path over the stretch
/// that such a stop can reach, beside the speed that it can have there. Where the joints'
/// derivatives vary along the piece, phases are cut into parts so that a stop on the easy stretch
/// is not as slow as one on the hard stretch.
class StopMarginTable {
 public:
  /// `offset` is the s of `cells` at which the piece begins.
  StopMarginTable(std::span<const JointCell> cells, double offset, const JointCaps& caps,
                  const JointCaps& fault_caps, const MotionChoice& choice) noexcept;

  static constexpr int kMaxCuts = 95;

  /// Times inside a phase, ascending.
  struct Cuts {
    std::array<double, kMaxCuts> time{};
    int count = 0;
  };

  /// Where to cut `phase` so that authorities differ little within a part.
  [[nodiscard]] Cuts cut(const ProfilePhase& phase) const noexcept;

  /// Fills in stop_* and fault_* of a part whose motion is set.
  void grant(TimePiece& time) const noexcept;

 private:
  /// A stretch of a phase, by its times.
  struct Part {
    double begin = 0, end = 0;
  };
  [[nodiscard]] std::span<const JointCell> cells_between(double begin, double end) const noexcept;
  [[nodiscard]] bool is_even(const ProfilePhase& phase, const Part& part) const noexcept;

  std::span<const JointCell> cells_;
  double offset_;
  const JointCaps& caps_;
  const JointCaps& fault_caps_;
  const MotionChoice& choice_;
  bool is_varied_;
};

}  // namespace meridian
