// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "meridian/planner/motion_port.hpp"

namespace meridian::test {

/// A port, and what was published to it and not taken yet.
struct Published {
  [[nodiscard]] std::vector<TimePiece> times() const {
    std::vector<TimePiece> out;
    while (const TimePiece* piece = port->times.peek(out.size())) out.push_back(*piece);
    return out;
  }
  [[nodiscard]] std::vector<PathPiece> paths() const {
    std::vector<PathPiece> out;
    while (const PathPiece* piece = port->paths.peek(out.size())) out.push_back(*piece);
    return out;
  }
  /// The cycle is in the newest window: no tail is left that it could enter instead.
  void begin_newest_window() {
    const auto all = times();
    if (all.empty()) return;
    port->window_begun.store((std::uint64_t{1} << 63U) | (std::uint64_t{all.back().epoch} << 32U) |
                             all.back().window);
  }

  std::unique_ptr<MotionPort> port = std::make_unique<MotionPort>();
  MotionWriter writer{*port};
};

}  // namespace meridian::test
