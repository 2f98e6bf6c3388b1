// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

#include "meridian/geometry/vector3.hpp"

namespace meridian {

enum class BlockKind : std::uint8_t {
  kCut,           ///< tip straight or on an arc at feed, tool axis on the great circle
  kRapid,         ///< the same path, limited by the joints alone
  kDwell,         ///< rest for `value` seconds
  kAuxiliary,     ///< spindle, coolant, vendor word: an action at rest
  kTool,          ///< tool change: an action at rest; `value` is the tool number
  kStop,          ///< program stop: Held until the operator resumes
  kOptionalStop,  ///< as kStop where the operator asked for it
  kEnd            ///< end of the program
};

enum class FeedMeaning : std::uint8_t {
  kNone,        ///< rapid and non-motion blocks
  kTip,         ///< `feed` is tip speed, mm/s
  kInverseTime  ///< `feed` is 1/duration of the block, 1/s
};

enum class ActionKind : std::uint8_t {
  kNone,
  kSpindleOff,
  kSpindleClockwise,         ///< `value` is rev/min
  kSpindleCounterClockwise,  ///< `value` is rev/min
  kCoolantOff,
  kCoolantFlood,
  kCoolantMist,
  kCoolantThrough,
  kToolChange,  ///< `value` is the tool number
  kStop,
  kVendorWord  ///< `text` is the word with its arguments
};

/// One cutter-location block: what the CAM station sends and the planner plans. The path of a
/// motion block starts where the block before it ended. Units: mm, rad, s. Frame: workpiece W.
struct ClBlock {
  std::uint64_t sequence = 0;  ///< counts all blocks of a session from 0
  std::uint32_t line = 0;      ///< line of the CL file that it came from, 1-based
  BlockKind kind = BlockKind::kCut;
  FeedMeaning feed_meaning = FeedMeaning::kNone;
  ActionKind action = ActionKind::kNone;
  bool is_arc = false;     ///< tip path is the arc given by centre, normal and sweep
  Array3 tip_mm{};         ///< end of the block
  Array3 axis{0, 0, 1};    ///< tool axis at its end, unit, tip to spindle
  Array3 centre_mm{};      ///< arc only: centre
  Array3 normal{0, 0, 1};  ///< arc only: unit; the tip turns right-handed about it
  double sweep_rad = 0;    ///< arc only: (0, 2π], travel along the normal is spread evenly (helix)
  double feed = 0;         ///< see FeedMeaning
  double value = 0;        ///< dwell s, tool number, rev/min
  char text[24] = {};      ///< vendor word, zero-terminated
};
static_assert(std::is_trivially_copyable_v<ClBlock>);

[[nodiscard]] constexpr bool is_motion(BlockKind kind) noexcept {
  return kind == BlockKind::kCut || kind == BlockKind::kRapid;
}

}  // namespace meridian
