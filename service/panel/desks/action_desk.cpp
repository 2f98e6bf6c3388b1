// SPDX-License-Identifier: Apache-2.0
#include "service/panel/desks/action_desk.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "service/drives/kit/action_words.hpp"
#include "service/panel/json_text.hpp"

namespace meridian::panel {
namespace {

/// A program that ended, was aborted or came to a fault waits for nobody.
[[nodiscard]] bool waits_for_actions(State state) {
  return state != State::kOff && state != State::kReady && state != State::kFault;
}

}  // namespace

ActionDesk::ActionDesk(dds::Participant& participant, Hub& hub)
    : hub_(hub), link_(participant), answers_(participant) {
  publish();
}

bool ActionDesk::take_asked() {
  bool is_new = false;
  dds::Action action;
  while (link_.take(action)) {
    const auto is_it = [&action](const dds::Action& known) { return known.id == action.id; };
    if (action.kind == ActionKind::kNone || std::any_of(open_.begin(), open_.end(), is_it))
      continue;
    // Those of a service that is gone wait for nothing any more.
    std::erase_if(open_,
                  [&](const dds::Action& known) { return known.service_id != action.service_id; });
    open_.push_back(action);
    if (open_.size() > kMaxOpen) open_.pop_front();
    is_new = true;
  }
  return is_new;
}

bool ActionDesk::take_answered(const std::optional<dds::Status>& status) {
  const std::size_t before = open_.size();
  dds::ActionDone done;
  while (answers_.take(done)) {
    std::erase_if(open_, [&done](const dds::Action& known) {
      return known.id == done.id && known.service_id == done.service_id;
    });
  }
  if (status && !waits_for_actions(status->state)) open_.clear();
  return open_.size() != before;
}

void ActionDesk::poll(const std::optional<dds::Status>& status) {
  const std::lock_guard lock(mutex_);
  const bool is_closed = take_answered(status);
  const bool is_asked = take_asked();
  if (is_closed || is_asked) publish();
}

Outcome ActionDesk::answer(std::uint64_t id, bool is_done) {
  const std::lock_guard lock(mutex_);
  const auto is_it = [id](const dds::Action& known) { return known.id == id; };
  const auto found = std::find_if(open_.begin(), open_.end(), is_it);
  if (found == open_.end()) return {false, "nothing waits for this answer any more"};
  const std::string words = drive::describe(*found);
  dds::ActionDone done;
  done.id = found->id;
  done.service_id = found->service_id;
  done.is_done = is_done;
  if (!is_done) done.text = "the operator could not do it";
  link_.answer(done);
  open_.erase(found);
  publish();
  return {true, words + (is_done ? ": done" : ": not done")};
}

/// With the lock, or before others know it.
void ActionDesk::publish() const {
  nlohmann::json open = nlohmann::json::array();
  for (const dds::Action& action : open_) {
    open.push_back({{"id", std::to_string(action.id)},
                    {"line", action.line},
                    {"text", drive::describe(action)}});
  }
  hub_.publish(Hub::kActions, json_text({{"t", "actions"}, {"open", open}}));
}

}  // namespace meridian::panel
