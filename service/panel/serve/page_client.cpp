// SPDX-License-Identifier: Apache-2.0
#include "service/panel/serve/page_client.hpp"

#include <civetweb.h>

#include <utility>

namespace meridian::panel {
namespace {

/// What is said to one page alone waits no longer than this.
constexpr std::chrono::milliseconds kBetweenTexts{15};

}  // namespace

PageClient::PageClient(Hub& hub, mg_connection* connection) : hub_(hub), connection_(connection) {}

PageClient::~PageClient() {
  is_ending_ = true;
  if (thread_.joinable()) thread_.join();
}

void PageClient::start() {
  thread_ = std::thread([this] { run(); });
}

void PageClient::say(std::string text) {
  const std::lock_guard lock(mutex_);
  said_.push_back(std::move(text));
  if (said_.size() > kKept) said_.pop_front();
}

bool PageClient::send(const std::string& text) {
  return mg_websocket_write(connection_, MG_WEBSOCKET_OPCODE_TEXT, text.data(), text.size()) > 0;
}

bool PageClient::send_said() {
  for (;;) {
    std::string text;
    {
      const std::lock_guard lock(mutex_);
      if (said_.empty()) return true;
      text = std::move(said_.front());
      said_.pop_front();
    }
    if (!send(text)) return false;
  }
}

void PageClient::run() {
  Hub::Cursor cursor;
  while (!is_ending_ && !hub_.is_closed()) {
    if (!send_said()) return;
    for (const Hub::Text& text : hub_.wait(cursor, kBetweenTexts)) {
      if (is_ending_ || !send(*text)) return;
    }
  }
}

}  // namespace meridian::panel
