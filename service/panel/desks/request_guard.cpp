// SPDX-License-Identifier: Apache-2.0
#include "service/panel/desks/request_guard.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace meridian::panel {

bool is_own_host(std::string_view host, std::uint16_t port) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"127.0.0.1", "localhost", "[::1]"};
  std::string ending(1, ':');
  ending += std::to_string(port);
  return std::any_of(kNames.begin(), kNames.end(), [&](std::string_view name) {
    return host.starts_with(name) && host.substr(name.size()) == ending;
  });
}

bool is_own_origin(std::string_view origin, std::string_view host) noexcept {
  constexpr std::string_view kScheme = "http://";
  return !host.empty() && origin.starts_with(kScheme) && origin.substr(kScheme.size()) == host;
}

}  // namespace meridian::panel
