// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/cycle/state.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/path_piece.hpp"

/// The words of a recording: column names, and what stands in the columns `kind` and `state`.
namespace meridian::record {

/// approach, cut, rapid, pole_turn, unwind.
[[nodiscard]] std::string_view word(MotionKind kind) noexcept;
/// off, enabling, ready, loaded, ... as in docs/operating.md, small letters.
[[nodiscard]] std::string_view word(State state) noexcept;

/// none, not_finite, travel, step, unreachable, drive_fault, feedback_lost, ...
[[nodiscard]] std::string_view word(Alarm alarm) noexcept;
/// Whether the alarm names a joint.
[[nodiscard]] bool is_of_joint(Alarm alarm) noexcept;
/// What a drive's statusword says: "operation enabled", "fault", ...; "silent" for 0.
[[nodiscard]] std::string_view drive_state_word(std::uint16_t statusword) noexcept;

[[nodiscard]] std::optional<MotionKind> find_motion_kind(std::string_view word) noexcept;
[[nodiscard]] std::optional<State> find_state(std::string_view word) noexcept;
[[nodiscard]] std::optional<Alarm> find_alarm(std::string_view word) noexcept;

/// name_mm or name_rad.
[[nodiscard]] std::string position_column(const JointSpec& joint);
/// name_mm_per_s or name_rad_per_s.
[[nodiscard]] std::string velocity_column(const JointSpec& joint);
/// Of a drive: name_feedback_mm or _rad, name_statusword, name_error.
[[nodiscard]] std::string feedback_column(const JointSpec& drive);
[[nodiscard]] std::string statusword_column(const JointSpec& drive);
[[nodiscard]] std::string drive_error_column(const JointSpec& drive);

}  // namespace meridian::record
