// SPDX-License-Identifier: Apache-2.0
#include "service/panel/serve/hub.hpp"

#include <utility>

namespace meridian::panel {

void Hub::publish(Kind kind, std::string text) {
  auto shared = std::make_shared<const std::string>(std::move(text));
  {
    const std::lock_guard lock(mutex_);
    texts_[kind] = std::move(shared);
    if (kind < kPageKinds) ++numbers_[kind];
  }
  changed_.notify_all();
}

bool Hub::has_news(const Cursor& cursor) const { return cursor.seen != numbers_; }

std::vector<Hub::Text> Hub::wait(Cursor& cursor, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] { return is_closed_ || has_news(cursor); });
  std::vector<Text> out;
  for (std::size_t kind = 0; kind < kPageKinds && !is_closed_; ++kind) {
    if (cursor.seen[kind] != numbers_[kind]) out.push_back(texts_[kind]);
  }
  cursor.seen = numbers_;
  return out;
}

Hub::Text Hub::newest(Kind kind) const {
  const std::lock_guard lock(mutex_);
  return texts_[kind];
}

void Hub::close() {
  {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
  }
  changed_.notify_all();
}

bool Hub::is_closed() const {
  const std::lock_guard lock(mutex_);
  return is_closed_;
}

}  // namespace meridian::panel
