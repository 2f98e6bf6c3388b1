// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <fcntl.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "service/host/probe/doctor/dds_network.hpp"

namespace meridian::probe {
namespace {

constexpr int kPatience_ms = 500;

/// A socket that is closed with it.
class Socket {
 public:
  explicit Socket(int type) : file_(::socket(AF_INET, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {}
  ~Socket() {
    if (file_ >= 0) ::close(file_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  [[nodiscard]] int file() const { return file_; }
  [[nodiscard]] bool waits_for(short events) const {
    pollfd one{.fd = file_, .events = events, .revents = 0};
    return ::poll(&one, 1, kPatience_ms) == 1;
  }

 private:
  int file_;
};

[[nodiscard]] std::string interface_of(const std::string& address) {
  in_addr wanted{};
  ifaddrs* list = nullptr;
  if (::inet_pton(AF_INET, address.c_str(), &wanted) != 1 || ::getifaddrs(&list) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(list, &::freeifaddrs);
  for (const ifaddrs* at = list; at != nullptr; at = at->ifa_next) {
    if (at->ifa_addr == nullptr || at->ifa_addr->sa_family != AF_INET) continue;
    sockaddr_in here{};
    std::memcpy(&here, at->ifa_addr, sizeof here);
    if (here.sin_addr.s_addr == wanted.s_addr) return at->ifa_name;
  }
  return {};
}

[[nodiscard]] bool carries_multicast(const std::string& interface) {
  const Socket socket(SOCK_DGRAM);
  sockaddr_in group{};
  group.sin_family = AF_INET;
  if (::bind(socket.file(), reinterpret_cast<const sockaddr*>(&group), sizeof group) != 0) {
    return false;
  }
  socklen_t size = sizeof group;
  ::getsockname(socket.file(), reinterpret_cast<sockaddr*>(&group), &size);
  ::inet_pton(AF_INET, "239.255.71.71", &group.sin_addr);
  ip_mreqn member{};
  member.imr_multiaddr = group.sin_addr;
  member.imr_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  if (member.imr_ifindex == 0 && !interface.empty()) return false;
  const unsigned char no_hop = 0;  // it stays on this host
  const auto set = [&socket](int option, const void* value, socklen_t length) {
    return ::setsockopt(socket.file(), IPPROTO_IP, option, value, length) == 0;
  };
  const char sent = 'm';
  if (!set(IP_ADD_MEMBERSHIP, &member, sizeof member) ||
      !set(IP_MULTICAST_IF, &member, sizeof member) ||
      !set(IP_MULTICAST_TTL, &no_hop, sizeof no_hop) ||
      ::sendto(socket.file(), &sent, 1, 0, reinterpret_cast<const sockaddr*>(&group),
               sizeof group) != 1) {
    return false;
  }
  char got = 0;
  return socket.waits_for(POLLIN) && ::recv(socket.file(), &got, 1, 0) == 1 && got == sent;
}

[[nodiscard]] Reach reach(const std::string& peer) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  addrinfo* list = nullptr;
  if (::getaddrinfo(peer.c_str(), "7400", &hints, &list) != 0) return Reach::kNoAddress;
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(list, &::freeaddrinfo);
  const Socket socket(SOCK_STREAM);
  int error = ::connect(socket.file(), list->ai_addr, list->ai_addrlen) == 0 ? 0 : errno;
  if (error == EINPROGRESS) {
    if (!socket.waits_for(POLLOUT)) return Reach::kSilent;
    socklen_t size = sizeof error;
    ::getsockopt(socket.file(), SOL_SOCKET, SO_ERROR, &error, &size);
  }
  if (error == 0 || error == ECONNREFUSED) return Reach::kAnswers;
  return error == ETIMEDOUT || error == EHOSTUNREACH ? Reach::kSilent : Reach::kNoRoute;
}

}  // namespace

NetworkView real_network() { return {&interface_of, &carries_multicast, &reach}; }

}  // namespace meridian::probe
