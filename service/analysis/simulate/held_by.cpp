// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/held_by.hpp"

namespace meridian::simulate {

std::string name_of(LimitId id, const MachineModel& model) {
  static constexpr const char* kOrders[] = {" velocity", " acceleration", " jerk"};
  switch (id) {
    case kNoLimit:
      return "none";
    case kFeedLimit:
      return "feed";
    case kMachineFeedLimit:
      return "machine feed";
    default:
      return limited_spec(model, joint_of(id)).name + kOrders[order_of(id)];
  }
}

const char* name_of(Cause cause) noexcept {
  static constexpr const char* kNames[kCauses] = {"feed", "path",     "bend",    "pole",
                                                  "rest", "override", "waiting", "rewind"};
  return kNames[static_cast<std::size_t>(cause)];
}

}  // namespace meridian::simulate
