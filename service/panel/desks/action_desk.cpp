// SPDX-License-Identifier: Apache-2.0
#include "service/panel/desks/action_desk.hpp"

#include <nlohmann/json.hpp>
#include <string>

#include "service/drives/kit/actions/action_words.hpp"
#include "service/panel/json_text.hpp"

namespace meridian::panel {

ActionDesk::ActionDesk(dds::Participant& participant, Hub& hub) : hub_(hub), link_(participant) {
  try {
    answers_.emplace(participant);
  } catch (const dds::DdsError&) {
    // What others answer stays on the page until the program goes on.
  }
  publish();
}

/// Asked before answered: who is quick does both between two polls.
void ActionDesk::take() {
  dds::Action action;
  while (link_.take(action)) awaited_.ask(action);
  dds::ActionDone done;
  while (answers_ && answers_->take(done)) static_cast<void>(awaited_.answer(done));
}

void ActionDesk::poll(const std::optional<dds::Status>& status) {
  const std::lock_guard lock(mutex_);
  const auto number = [this] { return awaited_.now() ? awaited_.now()->id : 0; };
  const std::uint64_t before = number();
  take();
  if (status) awaited_.follow(*status);
  if (number() != before) publish();
}

Outcome ActionDesk::answer(std::uint64_t id, bool is_done) {
  const std::lock_guard lock(mutex_);
  if (!awaited_.now() || awaited_.now()->id != id) {
    return {false, "nothing waits for this answer any more"};
  }
  dds::ActionDone done;
  done.id = id;
  done.service_id = awaited_.now()->service_id;
  done.is_done = is_done;
  if (!is_done) done.text = "the operator could not do it";
  link_.answer(done);
  const std::string words = drive::describe(*awaited_.now());
  static_cast<void>(awaited_.answer(done));
  publish();
  return {true, words + (is_done ? ": done" : ": not done")};
}

/// With the lock, or before others know it.
void ActionDesk::publish() const {
  nlohmann::json open = nlohmann::json::array();
  if (const auto& action = awaited_.now()) {
    open.push_back({{"id", std::to_string(action->id)},
                    {"line", action->line},
                    {"text", drive::describe(*action)}});
  }
  hub_.publish(Hub::kActions, json_text({{"t", "actions"}, {"open", open}}));
}

}  // namespace meridian::panel
