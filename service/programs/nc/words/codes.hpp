// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace meridian::nc {

/// What a G code does here. Codes of one kind shut each other out in a block.
enum class GKind : std::uint8_t {
  kMotion,      ///< `value`: Motion
  kPlane,       ///< `value`: the axis across it, 0 to 2
  kUnit,        ///< `value`: 1 for inch
  kDistance,    ///< `value`: 1 for incremental
  kCentre,      ///< of arcs; `value`: 1 for absolute
  kFeed,        ///< `value`: cl::FeedUnit
  kControl,     ///< of the tool centre; `value`: Control
  kWorkOffset,  ///< the place of the part, which the station's frame gives
  kCycle,       ///< `value`: 81 of G81, 0 ends it
  kReturn,      ///< of cycles; `value`: 1 to R
  kDwell,
  kHome,             ///< G28
  kReference,        ///< G30: a position of the machine file
  kMachinePosition,  ///< G53
  kPlaneTilt,        ///< G68.2
  kPlaneFollow,      ///< G53.1: the rotary axes follow it
  kPlaneOff,         ///< G69
  kLocalZero,        ///< G52
  kDynamicOffset,    ///< of Haas; `value`: 1 for G254, 0 for G255
  kNothing,          ///< says what holds anyway, or how the control smooths
  kSetting,          ///< the same, with words of its own (G5 P10000)
  kAxesSetting,      ///< the same, whose axis words name axes (G5.1 Q2 X0 Y0 Z0)
  kRefused
};

struct GRow {
  int tenths;  ///< G43.4 is 434
  GKind kind;
  std::uint8_t value = 0;
  std::string_view note = {};    ///< why it is refused
  std::string_view remedy = {};  ///< what to do then
};

/// What an M code does here; what stands in no row is passed to the machine as a vendor word.
enum class MKind : std::uint8_t {
  kStop,
  kOptionalStop,
  kEnd,
  kSpindle,  ///< `value`: ActionKind
  kCoolant,  ///< `value`: ActionKind
  kTool,
  kRefused
};

struct MRow {
  int code;
  MKind kind;
  std::uint8_t value = 0;
  std::string_view note = {};
  std::string_view remedy = "let the CAM system write one program without it";
};

[[nodiscard]] std::span<const GRow> g_rows();
/// Null where nobody knows the code.
[[nodiscard]] const GRow* find_g(double code) noexcept;
/// The same in a Siemens program.
[[nodiscard]] const GRow* find_siemens_g(double code) noexcept;
[[nodiscard]] const MRow* find_m(double code) noexcept;

}  // namespace meridian::nc
