// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

/// Whose requests are answered.
namespace meridian::panel {

/// Whether `host`, the header of a request to `port`, names this host by loopback: 127.0.0.1, [::1]
/// or localhost. A foreign name that leads to loopback (DNS rebinding) does not.
[[nodiscard]] bool is_own_host(std::string_view host, std::uint16_t port) noexcept;

/// Whether `origin`, the header of a request whose Host is `host`, is the page itself.
[[nodiscard]] bool is_own_origin(std::string_view origin, std::string_view host) noexcept;

}  // namespace meridian::panel
