// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

struct mg_connection;

/// Requests and answers of HTTP, as civetweb has them.
namespace meridian::panel::http {

inline constexpr const char* kPlainText = "text/plain; charset=utf-8";
inline constexpr const char* kHtml = "text/html; charset=utf-8";

/// A header of the request; empty: it is not there.
[[nodiscard]] std::string_view header_of(const mg_connection* connection, const char* name);

/// A variable of a query or of a form, decoded; empty where it is not there, or longer than any
/// that is meant.
[[nodiscard]] std::string find_variable(std::string_view query, const char* name);

/// The query of the request; empty: it has none.
[[nodiscard]] std::string_view query_of(const mg_connection* connection);

/// The body of the request; empty where it is longer than `max_bytes`, or its length is not said.
[[nodiscard]] std::string read_body(mg_connection* connection, long long max_bytes);

/// What an answer has beside its status and its bytes.
struct Form {
  std::string_view type = kPlainText;
  bool is_gzip = false;
  std::string_view headers = {};  ///< whole lines
};

/// Sends "HTTP/1.1 `status`" with the security headers of every answer, and `body` unless the
/// request is a HEAD.
void answer(mg_connection* connection, const char* status, std::string_view body,
            const Form& form = {});

}  // namespace meridian::panel::http
