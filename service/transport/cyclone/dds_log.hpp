// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

/// What the DDS library says of itself: samples that it cannot read, peers that behave oddly. It
/// says so in the thread that receives, so that wherever its lines go must never make it wait:
/// by itself it writes to standard error, and a full pipe there stops all that comes in.
/// Lines that are alike but for numbers are counted (text::AlikeLines); none holds a control
/// character. Proof: tests/integration/blocked_log_test.cpp.
namespace meridian::dds {

enum class LogWeight : std::uint8_t { kInfo, kWarning, kError };
using LogLine = std::function<void(LogWeight, const std::string&)>;

/// From now on lines go to `line`, which must not block; it is called by any thread, one at a time.
/// Traces that a configuration asks for go where that says, as ever.
void set_log(LogLine line);

/// From now on lines go to standard error; those that find no room there are lost, and counted.
void log_to_stderr();

/// Says how many lines were left out since; to be called now and then, and with `all` at the end.
void report_left_out(bool all = false);

}  // namespace meridian::dds
