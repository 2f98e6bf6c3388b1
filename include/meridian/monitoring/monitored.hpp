// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

/// What goes into the monitoring of a machine, and what comes out. This room includes nothing but
/// the standard library: it shares no code with planner and cycle, so that one mistake is not made
/// twice. Everything is plain, of fixed size and fed once a cycle. Units: mm or rad, s.
/// An axis has a drive of the same index, which is what moves it unless there is a stage between:
/// limits and values of drives are marked as such.
/// docs/monitoring.md says what each function is for. It is no safety function. RT: cycle.
namespace meridian::monitoring {

inline constexpr std::size_t kAxes = 6;
using Values = std::array<double, kAxes>;  ///< by axis, machine order
using Point = std::array<double, 3>;       ///< over the base, mm

/// What the machine is doing.
enum class Motion : std::uint8_t {
  kOff,     ///< drives are off, or on their way on or off
  kHoming,  ///< drives search for their references by themselves
  kRest,    ///< every axis is to stand
  kJog,     ///< an operator jogs, hold-to-run
  kProgram  ///< it moves by itself, or comes to rest from that
};

/// What is monitored for.
enum class Mode : std::uint8_t {
  kOff,        ///< nothing
  kAutomatic,  ///< motion behind shut guards
  kSetUp,      ///< jogs with an open guard
  kStandstill  ///< nothing may move
};

/// What is allowed of one axis and its drive.
struct AxisLimits {
  double speed = 0;          ///< its maximum
  double set_up_speed = 0;   ///< with an open guard
  double standstill = 0;     ///< so far it may leave its position in standstill
  double drive_speed = 0;    ///< maximum of its drive
  double frozen = 0;         ///< led on by more than this its drive has to change its position
  double window_margin = 0;  ///< of both windows
  bool has_window = false;   ///< false: an endless axis without one
  double low = 0, high = 0;  ///< window in automatic mode
  double set_up_low = 0, set_up_high = 0;
  bool has_model = false;      ///< the three below count
  double time_constant_s = 0;  ///< of the drive: at speed v it is v * time_constant_s behind
  int delay_cycles = 0;        ///< setpoints are followed so much later
  double model_error = 0;      ///< so far the drive may be off the model
};

/// What is allowed of a machine.
struct Limits {
  int axis_count = 0;
  double cycle_s = 0.001;
  double set_up_tip_speed = 2000.0 / 60;  ///< mm/s, with an open guard
  double guard_stop_s = 2;                ///< what moved when a guard opened has so long to stop
  double settle_s = 0.5;                  ///< from rest of the setpoint to standstill
  bool has_stage = false;                 ///< drives move an axis together
  std::array<AxisLimits, kAxes> axes{};
};

/// One cycle.
struct Inputs {
  Motion motion = Motion::kOff;
  bool is_guard_open = false;
  bool has_report = false;       ///< every axis reports a finite position, not long ago
  int periods = 1;               ///< since the cycle before; more where some were lost
  std::uint64_t cycle = 0;       ///< number of `commanded`
  Values commanded{};            ///< setpoints of the drives, as sent last
  std::uint32_t known_mask = 0;  ///< axes that know where they are
  Values reported{};             ///< positions of the drives
  Values measured{};             ///< of the axes, from those of the drives
  std::array<std::int64_t, kAxes> arrival_ns{};   ///< of the newest report of each axis
  std::array<std::uint64_t, kAxes> cycle_seen{};  ///< newest setpoint that its drive had taken then
  Point tip{};                                    ///< of the measured axes; only its changes count
};

enum class Finding : std::uint8_t {
  kNone,
  kStandstill,
  kAxisSpeed,
  kTipSpeed,  ///< `axis` means nothing
  kPositionWindow,
  kDriveModel,
  kJump,
  kFrozen,
  kDriveTooFast,
  kAxisTooFast
};

/// Whether `Result::axis` is a drive.
[[nodiscard]] constexpr bool is_of_drive(Finding finding) noexcept {
  return finding == Finding::kDriveModel || finding == Finding::kJump ||
         finding == Finding::kFrozen || finding == Finding::kDriveTooFast;
}

/// What was found first in a cycle. `value`: how far, where, or how fast.
struct Result {
  Finding finding = Finding::kNone;
  int axis = 0;
  double value = 0;
};

static_assert(std::is_trivially_copyable_v<Limits> && std::is_trivially_copyable_v<Inputs>);

}  // namespace meridian::monitoring
