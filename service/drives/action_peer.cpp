// SPDX-License-Identifier: Apache-2.0
#include "service/drives/action_peer.hpp"

#include <cstdio>

namespace meridian::drives {

std::string describe(const dds::Action& action) {
  char buffer[96];
  const auto with = [&](const char* format) {
    std::snprintf(buffer, sizeof buffer, format, action.value);
    return std::string(buffer);
  };
  switch (action.kind) {
    case ActionKind::kNone:
      return "nothing";
    case ActionKind::kSpindleOff:
      return "spindle off";
    case ActionKind::kSpindleClockwise:
      return with("spindle clockwise %.6g rev/min");
    case ActionKind::kSpindleCounterClockwise:
      return with("spindle counter-clockwise %.6g rev/min");
    case ActionKind::kCoolantOff:
      return "coolant off";
    case ActionKind::kCoolantFlood:
      return "coolant flood";
    case ActionKind::kCoolantMist:
      return "coolant mist";
    case ActionKind::kCoolantThrough:
      return "coolant through the tool";
    case ActionKind::kToolChange:
      return with("change to tool %.6g");
    case ActionKind::kStop:
      return "program stop";
    case ActionKind::kVendorWord:
      return "vendor word " + action.text;
  }
  return "unknown action";
}

}  // namespace meridian::drives
