// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/path_piece.hpp"
#include "meridian/rt/state.hpp"

/// The words of a recording: column names, and what stands in the columns `kind` and `state`.
namespace meridian::record {

/// approach, cut, rapid, pole_turn, unwind.
[[nodiscard]] std::string_view word(MotionKind kind) noexcept;
/// off, enabling, ready, loaded, ... as in docs/operating.md, small letters.
[[nodiscard]] std::string_view word(State state) noexcept;

[[nodiscard]] std::optional<MotionKind> find_motion_kind(std::string_view word) noexcept;
[[nodiscard]] std::optional<State> find_state(std::string_view word) noexcept;

/// name_mm or name_rad.
[[nodiscard]] std::string position_column(const JointSpec& joint);
/// name_mm_per_s or name_rad_per_s.
[[nodiscard]] std::string velocity_column(const JointSpec& joint);

}  // namespace meridian::record
