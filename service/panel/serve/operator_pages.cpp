// SPDX-License-Identifier: Apache-2.0
#include "service/panel/serve/operator_pages.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "meridian/cycle/state_table.hpp"
#include "service/panel/json_text.hpp"
#include "service/protocol/operator/operator_link.hpp"
#include "service/text/printed.hpp"

namespace meridian::panel {
namespace {

using nlohmann::json;

/// 128 bits that nobody guesses.
[[nodiscard]] std::string new_key() {
  std::string key;
  for (int i = 0; i < 2; ++i) text::append(key, "%016llx", text::Count{stream::draw_id()});
  return key;
}

}  // namespace

void OperatorPages::open(PageLink& page) {
  {
    const std::lock_guard lock(mutex_);
    pages_.emplace(++count_, Page{&page, new_key()});
  }
  say_who_operates();
}

void OperatorPages::close(PageLink& page) {
  {
    const std::lock_guard lock(mutex_);
    const auto is_it = [&page](const auto& one) { return one.second.link == &page; };
    const auto found = std::find_if(pages_.begin(), pages_.end(), is_it);
    if (found == pages_.end()) return;
    if (grip_ && grip_->page() == found->first) grip_->let_go();
    if (operator_ == found->first) operator_ = 0;
    pages_.erase(found);
  }
  say_who_operates();
}

void OperatorPages::read(PageLink& page, std::string_view text) {
  const auto message = read_page_message(text);
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [known, one] : pages_) {
      if (one.link == &page) number = known;
    }
  }
  if (message && number != 0) handle(number, *message);
}

void OperatorPages::handle(std::uint64_t page, const PageMessage& message) {
  switch (message.kind) {
    case PageMessage::Kind::kAsk:
      return ask(page, message);
    case PageMessage::Kind::kJog:
      return jog(page, message);
    case PageMessage::Kind::kTakeOver:
      return take_over(page);
    case PageMessage::Kind::kCheck:
    case PageMessage::Kind::kLoad:
    case PageMessage::Kind::kUnload:
    case PageMessage::Kind::kAnswer:
      return serve(page, message);
    case PageMessage::Kind::kRelease:
      break;
  }
  const std::lock_guard lock(mutex_);
  if (grip_ && grip_->is_of(page, message.id)) grip_->let_go();
}

bool OperatorPages::may_operate(std::uint64_t page) {
  bool is_new = false;
  {
    const std::lock_guard lock(mutex_);
    if (operator_ == page) return true;
    is_new = operator_ == 0;
    if (is_new) operator_ = page;
  }
  if (is_new) say_who_operates();
  return is_new;
}

void OperatorPages::ask(std::uint64_t page, const PageMessage& message) {
  if (!is_stop(message.verb) && !may_operate(page)) {
    return answer(page, message.id, {false, kOtherOperates});
  }
  desk_.ask(message.verb, message.argument, message.seen,
            [this, page, id = message.id](const Outcome& outcome) { answer(page, id, outcome); });
}

void OperatorPages::serve(std::uint64_t page, const PageMessage& message) {
  const bool may = may_operate(page);
  answer(page, message.id, may ? desk_.serve(message) : Outcome{false, kOtherOperates});
}

bool OperatorPages::may_operate(std::string_view key) {
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [known, page] : pages_) {
      if (page.key == key) number = known;
    }
  }
  return number != 0 && may_operate(number);
}

/// A status comes twenty times a second, and on change.
bool OperatorPages::sees_now(const stream::Seen& seen) const {
  constexpr std::uint64_t kLate = 10;
  const std::uint64_t newest = desk_.newest_status();
  return newest != 0 && seen.status_sequence + kLate >= newest;
}

/// A beat of the grip that is held, or the press that begins one. A grip that was let go presses
/// nothing any more, however many beats of it are still on their way.
void OperatorPages::jog(std::uint64_t page, const PageMessage& message) {
  const auto now = JogGrip::Clock::now();
  if (!may_operate(page)) return answer(page, message.id, {false, kOtherOperates});
  std::shared_ptr<JogGrip> grip;
  {
    const std::lock_guard lock(mutex_);
    if (grip_ && grip_->is_of(page, message.id)) {
      return sees_now(message.seen) ? grip_->beat(now) : grip_->let_go();
    }
    if (grip_ && grip_->is_older(page, message.id)) return;
    if (grip_) grip_->let_go();
    grip = std::make_shared<JogGrip>(page, message.id, now);
    grip_ = grip;
  }
  desk_.jog(message.plan, grip,
            [this, page, id = message.id](const Outcome& outcome) { answer(page, id, outcome); });
}

void OperatorPages::take_over(std::uint64_t page) {
  {
    const std::lock_guard lock(mutex_);
    if (grip_ && grip_->page() != page) grip_->let_go();
    operator_ = page;
  }
  say_who_operates();
}

void OperatorPages::say(std::uint64_t page, const std::string& text) {
  const std::lock_guard lock(mutex_);
  const auto found = pages_.find(page);
  if (found != pages_.end()) found->second.link->say(text);
}

void OperatorPages::say_who_operates() {
  const std::lock_guard lock(mutex_);
  for (const auto& [number, page] : pages_) {
    const char* const who = operator_ == 0 ? "nobody" : operator_ == number ? "you" : "another";
    page.link->say(json_text({{"t", "operator"}, {"who", who}, {"key", page.key}}));
  }
}

void OperatorPages::answer(std::uint64_t page, std::uint64_t id, const Outcome& outcome) {
  say(page,
      json_text(
          {{"t", "reply"}, {"id", id}, {"accepted", outcome.is_accepted}, {"text", outcome.text}}));
}

}  // namespace meridian::panel
