// SPDX-License-Identifier: Apache-2.0
#include "service/panel/serve/http.hpp"

#include <civetweb.h>

#include <array>

namespace meridian::panel::http {
namespace {

/// No script, style, picture or link but the page's own; nobody shows it in a frame.
constexpr const char* kSecurityHeaders =
    "Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'self'; "
    "frame-ancestors 'none'\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: same-origin\r\n"
    "Cross-Origin-Opener-Policy: same-origin\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n"
    "Cache-Control: no-cache\r\n";

}  // namespace

std::string_view header_of(const mg_connection* connection, const char* name) {
  const char* const value = mg_get_header(connection, name);
  return value != nullptr ? value : "";
}

std::string find_variable(std::string_view query, const char* name) {
  std::array<char, 512> value{};
  const int length = mg_get_var(query.data(), query.size(), name, value.data(), value.size());
  return length > 0 ? std::string(value.data(), static_cast<std::size_t>(length)) : "";
}

std::string_view query_of(const mg_connection* connection) {
  const char* const query = mg_get_request_info(connection)->query_string;
  return query != nullptr ? query : "";
}

std::string read_body(mg_connection* connection, long long max_bytes) {
  const long long length = mg_get_request_info(connection)->content_length;
  if (length <= 0 || length > max_bytes) return "";
  std::string body(static_cast<std::size_t>(length), '\0');
  std::size_t got = 0;
  while (got < body.size()) {
    const int read = mg_read(connection, body.data() + got, body.size() - got);
    if (read <= 0) return "";
    got += static_cast<std::size_t>(read);
  }
  return body;
}

void answer(mg_connection* connection, const char* status, std::string_view body,
            const Form& form) {
  const std::string_view method = mg_get_request_info(connection)->request_method;
  mg_printf(connection,
            "HTTP/1.1 %s\r\n%s%.*sContent-Type: %.*s\r\nContent-Length: %zu\r\n%sConnection: close"
            "\r\n\r\n",
            status, kSecurityHeaders, static_cast<int>(form.headers.size()), form.headers.data(),
            static_cast<int>(form.type.size()), form.type.data(), body.size(),
            form.is_gzip ? "Content-Encoding: gzip\r\n" : "");
  if (method != "HEAD") mg_write(connection, body.data(), body.size());
}

}  // namespace meridian::panel::http
