// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "service/programs/nc/frames/machine_axes.hpp"
#include "service/programs/nc/modes.hpp"

namespace meridian::nc {

inline constexpr double kMaxTurn_deg = 36000;  ///< of one block: a hundred turns
inline constexpr int kMaxPieces = 4096;        ///< of one block

/// The rotary words `share` of the way from `from` to `to`; what `from` does not have was at zero.
[[nodiscard]] std::vector<RotaryAt> between(const std::vector<RotaryAt>& from,
                                            const std::vector<RotaryAt>& to, double share);

/// The largest turn of one axis, deg.
[[nodiscard]] double largest_turn_deg(const std::vector<RotaryAt>& from,
                                      const std::vector<RotaryAt>& to);

/// Under G43.4 the control turns every rotary joint evenly; a block of ours turns the tool axis on
/// a great circle. Returns into how many even pieces a block has to be cut so that in the middle of
/// each both are no farther apart than `tolerance_rad`: 1, or as many as doubling finds. Proof:
/// tests/unit/nc/turn_test.cpp.
[[nodiscard]] int pieces_of_turn(const MachineAxes& axes, const std::vector<RotaryAt>& from,
                                 const std::vector<RotaryAt>& to, double tolerance_rad);

}  // namespace meridian::nc
