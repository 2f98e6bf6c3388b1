// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/auxiliaries.hpp"

#include <optional>

#include "meridian/cycle/state_table.hpp"
#include "service/drives/kit/actions/action_words.hpp"

namespace meridian::panel {

void Auxiliaries::answer(const dds::ActionDone& done) {
  const std::optional<dds::Action> action = awaited_.answer(done);
  if (!action || !done.is_done) return;
  switch (action->kind) {
    case ActionKind::kSpindleOff:
    case ActionKind::kSpindleClockwise:
    case ActionKind::kSpindleCounterClockwise:
      spindle_ = drive::describe(*action);
      break;
    case ActionKind::kCoolantOff:
    case ActionKind::kCoolantFlood:
    case ActionKind::kCoolantMist:
    case ActionKind::kCoolantThrough:
      coolant_ = drive::describe(*action);
      break;
    default:
      break;
  }
}

void Auxiliaries::follow(const dds::Status& status) {
  awaited_.follow(status);
  if (status.state == State::kOff || is_fault(status.state)) {
    spindle_.clear();
    coolant_.clear();
  }
}

std::string Auxiliaries::waits_for() const {
  return awaited_.now() ? drive::describe(*awaited_.now()) : "";
}

}  // namespace meridian::panel
