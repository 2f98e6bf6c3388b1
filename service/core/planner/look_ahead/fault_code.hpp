// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/path/block_reject.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"

namespace meridian {

/// What a block is refused for whose joints cannot follow its path.
[[nodiscard]] inline RejectCode code_of(PathFault::Kind kind) noexcept {
  switch (kind) {
    case PathFault::Kind::kNone:
      return RejectCode::kNone;
    case PathFault::Kind::kTravel:
      return RejectCode::kTravelBetween;
    case PathFault::Kind::kUnreachable:
      return RejectCode::kUnreachable;
    case PathFault::Kind::kTooLong:
      return RejectCode::kTooComplex;
    case PathFault::Kind::kBranch:
      return RejectCode::kBranch;
    case PathFault::Kind::kKeepOut:
      return RejectCode::kKeepOut;
    case PathFault::Kind::kTipBox:
      return RejectCode::kTipBox;
    case PathFault::Kind::kJump:
      break;
  }
  return RejectCode::kDiscontinuous;
}

}  // namespace meridian
