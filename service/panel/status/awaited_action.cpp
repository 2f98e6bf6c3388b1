// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/awaited_action.hpp"

#include <utility>

namespace meridian::panel {

void AwaitedAction::ask(const dds::Action& action) {
  if (action.kind == ActionKind::kNone) return;
  action_ = action;
  has_held_ = false;
}

std::optional<dds::Action> AwaitedAction::answer(const dds::ActionDone& done) {
  const bool is_it = action_ && action_->id == done.id && action_->service_id == done.service_id;
  return is_it ? std::exchange(action_, std::nullopt) : std::nullopt;
}

void AwaitedAction::follow(const dds::Status& status) {
  if (!action_) return;
  if (status.service_id != action_->service_id) return action_.reset();
  switch (status.state) {
    case State::kOff:
    case State::kReady:
    case State::kFault:
      action_.reset();
      return;
    case State::kHeld:
      has_held_ = true;
      return;
    default:
      if (has_held_ && action_->kind == ActionKind::kStop) action_.reset();
      return;
  }
}

}  // namespace meridian::panel
