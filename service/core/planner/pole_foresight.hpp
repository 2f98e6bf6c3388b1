// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/look_ahead.hpp"

namespace meridian {

/// How many blocks ways behind the pole carry, which may have to wait for blocks.
///
///     ask() ─▶ look() ─ false: blocks are missing, again when there are more ─▶ ways()
class PoleForesight {
 public:
  virtual ~PoleForesight() = default;

  /// `ways` start at `start`, on the way to the end of block `sequence`.
  virtual void ask(std::uint64_t sequence, const ToolPose& start, double tool_length_mm,
                   std::span<const AheadWay> ways) noexcept = 0;
  /// Whether the answer to what was asked last is known.
  [[nodiscard]] virtual bool look() noexcept = 0;
  [[nodiscard]] virtual std::span<const AheadWay> ways() const noexcept = 0;
};

}  // namespace meridian
