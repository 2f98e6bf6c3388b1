// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "service/recording/trace/slow_cycles.hpp"
#include "service/recording/trace/spans.hpp"

namespace meridian::trace {

/// A thread as a trace shows it, from above to below.
enum class Track : std::uint8_t { kCycle, kPublisher, kReceive, kPlanner, kIntake };
inline constexpr std::size_t kTracks = 5;

/// What was going on around a slow cycle.
struct Window {
  SlowCycle slow;                                  ///< the worst one in it
  std::int64_t begin_ns = 0, end_ns = 0;           ///< machine's clock
  std::array<std::vector<Span>, kTracks> spans{};  ///< by Track, each in its order
  std::uint64_t lost = 0;                          ///< spans without room since the service started
  std::string machine, service_version, host;
};

/// One sentence: which cycle, how late, how long.
[[nodiscard]] std::string describe(const SlowCycle& slow);

/// The window in the Trace Event Format, which ui.perfetto.dev and chrome://tracing open: one
/// complete event for each span, µs since the window's begin, or since the begin of what was under
/// way then; slices of a thread follow one another. Source: "Trace Event Format",
/// Chromium project. Proof: tests/unit/daemon/trace_format_test.cpp.
[[nodiscard]] std::string to_json(const Window& window);

}  // namespace meridian::trace
