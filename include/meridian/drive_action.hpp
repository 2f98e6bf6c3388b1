// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace meridian::drive {

enum class ActionKind : std::uint8_t {
  kNone,
  kSpindleOff,
  kSpindleClockwise,         ///< Action::value is rev/min
  kSpindleCounterClockwise,  ///< Action::value is rev/min
  kCoolantOff,
  kCoolantFlood,
  kCoolantMist,
  kCoolantThrough,
  kToolChange,  ///< Action::value is the tool number
  kStop,        ///< a program stop: until the operator resumes, nobody has to do anything
  kVendorWord   ///< Action::text is the word with its arguments
};

/// What the path waits for at rest: spindle, coolant, tool, a word of the machine's builder.
struct Action {
  ActionKind kind = ActionKind::kNone;
  double value = 0;
  std::string text;
  std::uint32_t line = 0;  ///< of the program
  std::string words;       ///< for people: "spindle clockwise 8000 rev/min"
};

/// Does an action and returns when it is done: an empty string, or why it is refused. Called on a
/// thread of its own, one action at a time; it may wait.
using Act = std::function<std::string(const Action&)>;

}  // namespace meridian::drive
