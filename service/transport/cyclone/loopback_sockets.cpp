// SPDX-License-Identifier: Apache-2.0
#include "service/transport/cyclone/loopback_sockets.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>

#include <charconv>
#include <filesystem>
#include <string>
#include <system_error>

namespace meridian::dds {
namespace {

[[nodiscard]] bool receives_on_all_interfaces(int descriptor) {
  sockaddr_storage address{};
  socklen_t length = sizeof address;
  if (::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &length) != 0) return false;
  if (address.ss_family == AF_INET) {
    return reinterpret_cast<const sockaddr_in&>(address).sin_addr.s_addr == htonl(INADDR_ANY);
  }
  if (address.ss_family != AF_INET6) return false;
  return IN6_IS_ADDR_UNSPECIFIED(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr) != 0;
}

/// The descriptors of this process that receives_on_all_interfaces() holds for.
[[nodiscard]] std::set<int> open_sockets() {
  std::set<int> out;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", ignored)) {
    const std::string name = entry.path().filename().string();
    int descriptor = -1;
    std::from_chars(name.data(), name.data() + name.size(), descriptor);
    if (receives_on_all_interfaces(descriptor)) out.insert(descriptor);
  }
  return out;
}

}  // namespace

SocketsBefore::SocketsBefore() : open_(open_sockets()) {}

int SocketsBefore::confine_newer_to_loopback() const {
  constexpr char kLoopback[] = "lo";
  int count = 0;
  for (const int descriptor : open_sockets()) {
    if (open_.contains(descriptor)) continue;
    const int result =
        ::setsockopt(descriptor, SOL_SOCKET, SO_BINDTODEVICE, kLoopback, sizeof kLoopback);
    count += result == 0 ? 1 : 0;
  }
  return count;
}

}  // namespace meridian::dds
