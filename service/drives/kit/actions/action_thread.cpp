// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/actions/action_thread.hpp"

#include <chrono>
#include <exception>

#include "service/drives/kit/actions/action_words.hpp"

namespace meridian::drive {
namespace {

static_assert(static_cast<int>(ActionKind::kVendorWord) ==
              static_cast<int>(meridian::ActionKind::kVendorWord));

[[nodiscard]] Action action_of(const dds::Action& sent) {
  return {static_cast<ActionKind>(sent.kind), sent.value, sent.text, sent.line, describe(sent)};
}

}  // namespace

ActionThread::ActionThread(dds::Participant& participant, const Act& act,
                           const Intake::Report& report)
    : act_(act), report_(report), link_(participant) {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void ActionThread::run(const std::stop_token& stop) {
  constexpr auto kBetweenLooks = std::chrono::milliseconds(5);
  dds::Action sent;
  while (!stop.stop_requested()) {
    if (!link_.take(sent)) {
      std::this_thread::sleep_for(kBetweenLooks);
      continue;
    }
    const Action action = action_of(sent);
    report_("action " + std::to_string(sent.id) + ", line " + std::to_string(sent.line) + ": " +
            action.words);
    dds::ActionDone done;
    done.id = sent.id;
    done.service_id = sent.service_id;
    done.text = do_it(action);
    done.is_done = done.text.empty();
    link_.answer(done);
  }
}

std::string ActionThread::do_it(const Action& action) const {
  try {
    return act_(action);
  } catch (const std::exception& error) {
    return std::string("refused: ") + error.what();
  }
}

}  // namespace meridian::drive
