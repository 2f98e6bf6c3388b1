// SPDX-License-Identifier: Apache-2.0
#include "service/panel/auxiliaries.hpp"

#include <algorithm>

#include "service/drives/kit/action_words.hpp"

namespace meridian::panel {

void Auxiliaries::ask(const dds::Action& action) {
  if (action.kind == ActionKind::kNone) return;
  std::erase_if(open_,
                [&](const dds::Action& known) { return known.service_id != action.service_id; });
  open_.push_back(action);
  if (open_.size() > kMaxOpen) open_.pop_front();
}

void Auxiliaries::answer(const dds::ActionDone& done) {
  const auto found = std::find_if(open_.begin(), open_.end(), [&done](const dds::Action& asked) {
    return asked.id == done.id && asked.service_id == done.service_id;
  });
  if (found == open_.end()) return;
  if (done.is_done) {
    switch (found->kind) {
      case ActionKind::kSpindleOff:
      case ActionKind::kSpindleClockwise:
      case ActionKind::kSpindleCounterClockwise:
        spindle_ = drive::describe(*found);
        break;
      case ActionKind::kCoolantOff:
      case ActionKind::kCoolantFlood:
      case ActionKind::kCoolantMist:
      case ActionKind::kCoolantThrough:
        coolant_ = drive::describe(*found);
        break;
      default:
        break;
    }
  }
  open_.erase(found);
}

void Auxiliaries::follow(const dds::Status& status) {
  switch (status.state) {
    case State::kOff:
    case State::kFaultStop:
    case State::kFault:
      spindle_.clear();
      coolant_.clear();
      open_.clear();
      break;
    case State::kReady:
      open_.clear();
      break;
    default:
      break;
  }
}

std::string Auxiliaries::waits_for() const {
  return open_.empty() ? "" : drive::describe(open_.back());
}

}  // namespace meridian::panel
