// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/notify.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace meridian::interpolator {
namespace {

/// The service manager's end: a datagram socket that the environment names.
class Manager {
 public:
  Manager() {
    path_ =
        std::filesystem::temp_directory_path() / ("meridian-notify-" + std::to_string(::getpid()));
    std::filesystem::remove(path_);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, path_.c_str());
    socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::setenv("NOTIFY_SOCKET", path_.c_str(), 1);
    ::setenv("WATCHDOG_USEC", "1000000", 1);
  }
  ~Manager() {
    ::close(socket_);
    std::filesystem::remove(path_);
    ::unsetenv("NOTIFY_SOCKET");
    ::unsetenv("WATCHDOG_USEC");
  }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  /// What was sent since the last call; empty where nothing was.
  [[nodiscard]] std::string heard() const {
    std::array<char, 512> text{};
    const auto got = ::recv(socket_, text.data(), text.size(), MSG_DONTWAIT);
    return got > 0 ? std::string(text.data(), static_cast<std::size_t>(got)) : "";
  }

 private:
  std::filesystem::path path_;
  int socket_ = -1;
};

TEST(ServiceManager, HearsThatTheServiceIsReadyAndStops) {
  const Manager manager;
  ServiceManager service;
  service.is_ready("answering in Off");
  EXPECT_EQ(manager.heard(), "READY=1\nSTATUS=answering in Off");
  service.is_stopping();
  EXPECT_EQ(manager.heard(), "STOPPING=1");
}

TEST(ServiceManager, HearsBeatsAtHalfTheWatchdogsTimeWhileTheCycleRuns) {
  const Manager manager;
  ServiceManager service;
  const auto begin = std::chrono::steady_clock::now();
  const auto after = [begin](int ms) { return begin + std::chrono::milliseconds(ms); };
  service.beat(1, after(0));
  EXPECT_EQ(manager.heard(), "WATCHDOG=1");
  service.beat(400, after(400));
  EXPECT_EQ(manager.heard(), "");
  service.beat(510, after(510));
  EXPECT_EQ(manager.heard(), "WATCHDOG=1");
  service.beat(510, after(5000));  // the cycle hangs
  EXPECT_EQ(manager.heard(), "");
}

TEST(ServiceManager, SaysNothingWhereNobodyAsked) {
  ServiceManager service;
  service.is_ready("");
  service.beat(1, std::chrono::steady_clock::now());
}

}  // namespace
}  // namespace meridian::interpolator
