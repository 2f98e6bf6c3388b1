// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/route/route_ahead.hpp"

namespace meridian {

/// How many blocks routes behind the pole, or behind a rewind, carry, which may have to wait for
/// blocks.
///
///     ask() ─▶ look() ─ false: blocks are missing, again when there are more ─▶ routes()
class PoleLookAhead {
 public:
  virtual ~PoleLookAhead() = default;

  /// Where routes start: at the end of block `sequence`, or on its way.
  struct Start {
    std::uint64_t sequence = 0;
    bool is_on_path = false;
    ToolPose pose{Vector3::Zero(), Vector3::UnitZ()};
    double tool_length_mm = 0;
  };
  virtual void ask(const Start& start, std::span<const RouteAhead> routes) noexcept = 0;
  /// Whether the answer to what was asked last is known.
  [[nodiscard]] virtual bool look() noexcept = 0;
  [[nodiscard]] virtual std::span<const RouteAhead> routes() const noexcept = 0;
  /// Behind look(): routes may carry farther than the answer says, for no more blocks are followed.
  [[nodiscard]] virtual bool is_cut_short() const noexcept = 0;
};

}  // namespace meridian
