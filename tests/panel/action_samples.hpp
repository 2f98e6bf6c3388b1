// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/transport/convert/messages.hpp"

/// Actions, answers and statuses of service 7, as tests of the panel need them.
namespace meridian::panel {

[[nodiscard]] inline dds::Action asked(std::uint64_t id, ActionKind kind = ActionKind::kToolChange,
                                       double value = 0) {
  dds::Action action;
  action.id = id;
  action.service_id = 7;
  action.kind = kind;
  action.value = value;
  return action;
}

[[nodiscard]] inline dds::ActionDone answered(std::uint64_t id, std::uint64_t service = 7) {
  dds::ActionDone done;
  done.id = id;
  done.service_id = service;
  done.is_done = true;
  return done;
}

[[nodiscard]] inline dds::ActionDone refused(std::uint64_t id) {
  dds::ActionDone done = answered(id);
  done.is_done = false;
  return done;
}

[[nodiscard]] inline dds::Status in_state(State state, std::uint64_t service = 7) {
  dds::Status status;
  status.state = state;
  status.service_id = service;
  return status;
}

}  // namespace meridian::panel
