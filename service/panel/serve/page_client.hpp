// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "service/panel/serve/server.hpp"

struct mg_connection;

namespace meridian::panel {

/// The writing end of one page: a thread that sends what the hub has and what was said to this page
/// alone. It ends with the connection.
class PageClient : public PageLink {
 public:
  PageClient(Hub& hub, mg_connection* connection);
  ~PageClient() override;  ///< waits for a write under way
  PageClient(const PageClient&) = delete;
  PageClient& operator=(const PageClient&) = delete;

  void start();
  void say(std::string text) override;

 private:
  static constexpr std::size_t kKept = 64;
  void run();
  [[nodiscard]] bool send(const std::string& text);
  [[nodiscard]] bool send_said();

  Hub& hub_;
  mg_connection* connection_;
  std::mutex mutex_;
  std::deque<std::string> said_;
  std::atomic<bool> is_ending_{false};
  std::thread thread_;
};

}  // namespace meridian::panel
