// SPDX-License-Identifier: Apache-2.0
#include "service/panel/desks/request_guard.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace meridian::panel {
namespace {

constexpr std::string_view kPlain = "http://", kSecured = "https://";

[[nodiscard]] bool is_loopback_host(std::string_view host, std::uint16_t port) {
  constexpr std::array<std::string_view, 3> kNames{"127.0.0.1", "localhost", "[::1]"};
  const std::string ending = port_in_host(port), whole = ":" + std::to_string(port);
  return std::any_of(kNames.begin(), kNames.end(), [&](std::string_view name) {
    if (!host.starts_with(name)) return false;
    host.remove_prefix(name.size());
    return host == ending || host == whole;
  });
}

}  // namespace

std::string port_in_host(std::uint16_t port) {
  constexpr std::uint16_t kOfHttp = 80;
  return port == kOfHttp ? "" : ":" + std::to_string(port);
}

std::optional<std::string> public_host_of(std::string_view url) {
  constexpr std::string_view kOwnPort = ":443";  // browsers leave it out
  if (!url.starts_with(kSecured)) return std::nullopt;
  url.remove_prefix(kSecured.size());
  if (url.ends_with('/')) url.remove_suffix(1);
  if (url.ends_with(kOwnPort)) url.remove_suffix(kOwnPort.size());
  const bool is_host = !url.empty() && std::all_of(url.begin(), url.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '-' || c == ':' || c == '[' || c == ']';
  });
  if (!is_host) return std::nullopt;
  std::string host(url);
  std::transform(host.begin(), host.end(), host.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return host;
}

bool is_public_host(std::string_view host, const Site& site) noexcept {
  return !site.public_host.empty() && host == site.public_host;
}

bool is_own_host(std::string_view host, const Site& site) {
  return is_loopback_host(host, site.port) || is_public_host(host, site);
}

bool is_own_origin(std::string_view origin, std::string_view host, const Site& site) noexcept {
  const std::string_view scheme = is_public_host(host, site) ? kSecured : kPlain;
  return !host.empty() && origin.starts_with(scheme) && origin.substr(scheme.size()) == host;
}

}  // namespace meridian::panel
