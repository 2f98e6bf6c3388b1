// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// Whose requests are answered.
namespace meridian::panel {

/// The names by which browsers reach a panel: loopback at `port`, and the one of a TLS proxy in
/// front of it, as browsers write it into Host; empty: there is none.
struct Site {
  std::uint16_t port = 0;
  std::string public_host;  ///< "cell-4.shop:8443"
};

/// The public host of "https://cell-4.shop:8443"; nothing where `url` is no address of that form.
[[nodiscard]] std::optional<std::string> public_host_of(std::string_view url);

/// ":8090", as browsers write a port behind a host; empty for the one of http, which they leave
/// out.
[[nodiscard]] std::string port_in_host(std::uint16_t port);

/// Whether `host`, the header of a request, names `site`: 127.0.0.1, [::1] or localhost with its
/// port, or its public host. A foreign name that leads to loopback (DNS rebinding) does not.
[[nodiscard]] bool is_own_host(std::string_view host, const Site& site);

/// Whether `host` is the name of the TLS proxy.
[[nodiscard]] bool is_public_host(std::string_view host, const Site& site) noexcept;

/// Whether `origin`, the header of a request whose Host is `host`, is the page itself.
[[nodiscard]] bool is_own_origin(std::string_view origin, std::string_view host,
                                 const Site& site) noexcept;

}  // namespace meridian::panel
