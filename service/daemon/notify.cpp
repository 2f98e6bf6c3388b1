// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/notify.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace meridian::interpolator {

ServiceManager::ServiceManager() {
  const char* const address = std::getenv("NOTIFY_SOCKET");
  const char* const watchdog = std::getenv("WATCHDOG_USEC");
  if (address == nullptr || (address[0] != '/' && address[0] != '@')) return;
  address_ = address;
  socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const long long limit_us = watchdog != nullptr ? std::atoll(watchdog) : 0;
  if (limit_us > 0) watchdog_ = std::chrono::microseconds(limit_us);
}

ServiceManager::~ServiceManager() {
  if (socket_ >= 0) ::close(socket_);
}

void ServiceManager::send(const std::string& text) const noexcept {
  if (socket_ < 0) return;
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  if (address_.size() >= sizeof to.sun_path) return;
  std::memcpy(to.sun_path, address_.data(), address_.size());
  if (address_.front() == '@') to.sun_path[0] = '\0';  // an abstract socket
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size());
  (void)::sendto(socket_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
                 reinterpret_cast<const sockaddr*>(&to), length);
}

void ServiceManager::is_ready(const std::string& status) noexcept {
  send("READY=1\nSTATUS=" + status);
}

void ServiceManager::is_stopping() noexcept { send("STOPPING=1"); }

void ServiceManager::beat(std::uint64_t cycles,
                          std::chrono::steady_clock::time_point now) noexcept {
  if (!watchdog_ || cycles == cycles_ || now - reported_ < *watchdog_ / 2) return;
  cycles_ = cycles;
  reported_ = now;
  send("WATCHDOG=1");
}

}  // namespace meridian::interpolator
