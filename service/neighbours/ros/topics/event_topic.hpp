// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "meridian/cycle/state.hpp"
#include "service/neighbours/ros/cdr.hpp"
#include "service/recording/mcap/writer.hpp"

namespace meridian::ros {

/// As rcl_interfaces/Log counts them.
enum class Level : std::uint8_t { kInfo = 20, kWarning = 30, kError = 40 };

/// Of the event that the machine comes to `state`.
[[nodiscard]] Level level_of(State state) noexcept;

/// `/events`: what happened, in words; rcl_interfaces/Log.
/// Proof: tests/unit/ros/event_test.cpp.
class EventTopic {
 public:
  explicit EventTopic(mcap::Writer& writer);
  /// `source`: who did it; `line`: of the CL file, 0 where it is of none.
  void write(std::int64_t time_ns, Level level, std::string_view source, std::string_view text,
             std::uint32_t line = 0);
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

 private:
  mcap::Writer& writer_;
  std::uint16_t channel_;
  std::uint64_t count_ = 0;
  Cdr message_;
};

}  // namespace meridian::ros
