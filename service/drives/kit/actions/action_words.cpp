// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/actions/action_words.hpp"

#include <cstdio>

namespace meridian::drive {

std::string describe(const dds::Action& action) {
  char buffer[96];
  const auto with = [&](const char* format) {
    std::snprintf(buffer, sizeof buffer, format, action.value);
    return std::string(buffer);
  };
  switch (action.kind) {
    case meridian::ActionKind::kNone:
      return "nothing";
    case meridian::ActionKind::kSpindleOff:
      return "spindle off";
    case meridian::ActionKind::kSpindleClockwise:
      return with("spindle clockwise %.6g rev/min");
    case meridian::ActionKind::kSpindleCounterClockwise:
      return with("spindle counter-clockwise %.6g rev/min");
    case meridian::ActionKind::kCoolantOff:
      return "coolant off";
    case meridian::ActionKind::kCoolantFlood:
      return "coolant flood";
    case meridian::ActionKind::kCoolantMist:
      return "coolant mist";
    case meridian::ActionKind::kCoolantThrough:
      return "coolant through the tool";
    case meridian::ActionKind::kToolChange:
      return with("change to tool %.6g");
    case meridian::ActionKind::kStop:
      return "program stop";
    case meridian::ActionKind::kVendorWord:
      return "vendor word " + action.text;
  }
  return "unknown action";
}

}  // namespace meridian::drive
