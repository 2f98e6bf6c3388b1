// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

namespace meridian {

/// Why a block cannot be run: the same words from the check of single blocks at the intake and from
/// the planner, who checks the joint path between them.
enum class RejectCode : std::uint8_t {
  kNone,
  kNotFinite,      ///< a number is NaN or infinite; `value`: its place in the block, see the text
  kKind,           ///< kind, feed meaning or action is none that this version knows
  kAxisNotUnit,    ///< `value`: length of the tool axis
  kFeed,           ///< feed is not positive or absurd; `value`: feed, mm/min or 1/min
  kArc,            ///< the arc does not lead from the block before to this one's end; `value`: mm
  kValue,          ///< dwell, spindle speed or tool number out of range; `value`: it
  kUnknownTool,    ///< `value`: tool number
  kNoActionPeer,   ///< nobody there to do actions
  kUnreachable,    ///< no joints put the tool there
  kTravel,         ///< `joint` leaves travel at the block; `value`: joint position
  kTravelBetween,  ///< `joint` leaves travel between the block before and this one
  kBranch,         ///< no route from the block before on any branch and winding
  kApproach,       ///< no route from where the machine stands to the block
  kAxisReversal,   ///< the axis turns by half a turn: no great circle is meant
  kTooComplex,     ///< the block needs more pieces than a plan holds
  kDiscontinuous,  ///< at a singularity: its joints would jump, or creep; `value`: the jump
  kKeepOut,        ///< joints enter a keep-out box; `value`: its number from 0
  kTipBox          ///< the tip leaves its box; `joint`: 0 X, 1 Y, 2 Z of the base; `value`: where
};

/// The verdict on one block. Units: mm, rad. Trivially copyable: crosses rings.
struct BlockReject {
  std::uint64_t sequence = 0;
  std::uint32_t line = 0;
  RejectCode code = RejectCode::kNone;
  std::int32_t joint = -1;  ///< machine order, then the drives of the stage; -1: none; see kTipBox
  double value = 0;         ///< see RejectCode
};
static_assert(std::is_trivially_copyable_v<BlockReject>);

}  // namespace meridian
