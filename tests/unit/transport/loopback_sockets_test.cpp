// SPDX-License-Identifier: Apache-2.0
#include "service/transport/cyclone/loopback_sockets.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>

#include "service/transport/participant.hpp"
#include "support/private_domain.hpp"

namespace meridian::dds {
namespace {

/// The device that a socket is bound to; empty: none.
std::string device_of(int descriptor) {
  std::array<char, 32> name{};
  socklen_t length = name.size();
  ::getsockopt(descriptor, SOL_SOCKET, SO_BINDTODEVICE, name.data(), &length);
  return name.data();
}

TEST(LoopbackSockets, AreThoseMadeSinceThatAnyInterfaceReaches) {
  const int older = ::socket(AF_INET, SOCK_DGRAM, 0);
  const SocketsBefore before;
  const int any = ::socket(AF_INET, SOCK_DGRAM, 0), own = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::bind(own, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(before.confine_newer_to_loopback(), 1);
  EXPECT_EQ(device_of(any), "lo");
  EXPECT_EQ(device_of(older), "");
  for (const int descriptor : {older, any, own}) ::close(descriptor);
}

TEST(LoopbackSockets, OfAParticipantOnLoopbackAreClosedToOtherInterfaces) {
  const support::PrivateDomain domain;
  const Participant participant({.domain = domain.id(), .machine = "mill"});
  int open_to_all = 0, confined = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int descriptor = std::stoi(entry.path().filename().string());
    sockaddr_in address{};
    socklen_t length = sizeof address;
    if (::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &length) != 0) continue;
    if (address.sin_family != AF_INET || address.sin_addr.s_addr != htonl(INADDR_ANY)) continue;
    ++(device_of(descriptor) == "lo" ? confined : open_to_all);
  }
  EXPECT_EQ(open_to_all, 0);
  EXPECT_GE(confined, 2) << "discovery and data";
}

}  // namespace
}  // namespace meridian::dds
