// SPDX-License-Identifier: Apache-2.0
#include "service/panel/serve/server.hpp"

#include <civetweb.h>

#include <array>
#include <charconv>
#include <map>
#include <mutex>
#include <utility>

#include "service/panel/desks/request_guard.hpp"
#include "service/panel/page.hpp"
#include "service/panel/serve/page_client.hpp"

namespace meridian::panel {
namespace {

/// No script, style, picture or link but the page's own; nobody shows it in a frame.
constexpr const char* kHeaders =
    "Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "Cross-Origin-Opener-Policy: same-origin\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n"
    "Cache-Control: no-cache\r\n";

[[nodiscard]] std::string_view header_of(const mg_connection* connection, const char* name) {
  const char* const value = mg_get_header(connection, name);
  return value != nullptr ? value : "";
}

void answer(mg_connection* connection, const char* status, std::string_view type,
            std::string_view body, bool is_gzip = false) {
  const std::string_view method = mg_get_request_info(connection)->request_method;
  mg_printf(connection,
            "HTTP/1.1 %s\r\n%sContent-Type: %.*s\r\nContent-Length: %zu\r\n%sConnection: close\r\n"
            "\r\n",
            status, kHeaders, static_cast<int>(type.size()), type.data(), body.size(),
            is_gzip ? "Content-Encoding: gzip\r\n" : "");
  if (method != "HEAD") mg_write(connection, body.data(), body.size());
}

void refuse(mg_connection* connection, const char* status, std::string_view why) {
  answer(connection, status, "text/plain; charset=utf-8", why);
}

[[nodiscard]] const char* status_line(int status) {
  switch (status) {
    case 200:
      return "200 OK";
    case 403:
      return "403 Forbidden";
    default:
      return "409 Conflict";
  }
}

[[nodiscard]] std::string query_of(const mg_connection* connection) {
  const char* const query = mg_get_request_info(connection)->query_string;
  return query != nullptr ? query : "";
}

/// A variable of a query, decoded; empty where it is not there, or longer than any that is meant.
[[nodiscard]] std::string find_variable(const std::string& query, const char* name) {
  std::array<char, 512> value{};
  const int length = mg_get_var(query.data(), query.size(), name, value.data(), value.size());
  return length > 0 ? std::string(value.data(), static_cast<std::size_t>(length)) : "";
}

}  // namespace

struct Server::Impl {
  Impl(Hub& shared, PageHandler page_handler) : hub(shared), handler(std::move(page_handler)) {}

  [[nodiscard]] bool is_from_here(const mg_connection* connection) const {
    return is_own_host(header_of(connection, "Host"), port);
  }
  int serve(mg_connection* connection);
  void upload(mg_connection* connection);
  [[nodiscard]] std::optional<HttpAnswer> get(const mg_connection* connection,
                                              std::string_view path) const;
  [[nodiscard]] bool admits(const mg_connection* connection);
  void open(mg_connection* connection);
  [[nodiscard]] bool read(mg_connection* connection, int bits, std::string_view text);
  void close(const mg_connection* connection);

  Hub& hub;
  PageHandler handler;
  mg_context* context = nullptr;
  std::uint16_t port = 0;
  std::mutex mutex;
  std::map<const mg_connection*, std::unique_ptr<PageClient>> pages;
};

/// Answers one request; 1: done.
int Server::Impl::serve(mg_connection* connection) {
  const mg_request_info* const request = mg_get_request_info(connection);
  const std::string_view method = request->request_method;
  const std::string_view path = request->local_uri != nullptr ? request->local_uri : "";
  if (!is_from_here(connection)) {
    refuse(connection, "403 Forbidden", "this is no name of the panel's host\n");
  } else if (method == "POST" && path == "/program" && handler.upload) {
    upload(connection);
  } else if (method != "GET" && method != "HEAD") {
    refuse(connection, "405 Method Not Allowed", "GET and HEAD alone\n");
  } else if (path == "/metrics" && handler.metrics) {
    answer(connection, "200 OK", "text/plain; version=0.0.4; charset=utf-8", handler.metrics());
  } else if (const auto file = find_page_file(path)) {
    answer(connection, "200 OK", file->type, file->bytes, file->is_gzip);
  } else if (const auto found = get(connection, path)) {
    answer(connection, status_line(found->status), found->type, found->text);
  } else {
    refuse(connection, "404 Not Found", "the panel has no such page\n");
  }
  return 1;
}

std::optional<HttpAnswer> Server::Impl::get(const mg_connection* connection,
                                            std::string_view path) const {
  if (!handler.get) return std::nullopt;
  const std::string query = query_of(connection);
  return handler.get({path, [&query](const char* name) -> std::uint64_t {
                        const std::string value = find_variable(query, name);
                        std::uint64_t number = 0;
                        std::from_chars(value.data(), value.data() + value.size(), number);
                        return number;
                      }});
}

/// A browser says where a POST comes from: a page of another site is refused.
void Server::Impl::upload(mg_connection* connection) {
  const bool is_own = is_own_origin(header_of(connection, "Origin"), header_of(connection, "Host"));
  const long long bytes = mg_get_request_info(connection)->content_length;
  if (!is_own) return refuse(connection, "403 Forbidden", "this is no page of the panel\n");
  if (bytes < 0) return refuse(connection, "411 Length Required", "how long is the file?\n");
  const std::string query = query_of(connection);
  HttpUpload upload;
  upload.key = find_variable(query, "key");
  upload.name = find_variable(query, "name");
  upload.bytes = static_cast<std::uint64_t>(bytes);
  upload.read = [connection](char* buffer, std::size_t size) -> std::int64_t {
    return mg_read(connection, buffer, size);
  };
  const HttpAnswer done = handler.upload(upload);
  answer(connection, status_line(done.status), done.type, done.text);
}

bool Server::Impl::admits(const mg_connection* connection) {
  const std::lock_guard lock(mutex);
  return is_from_here(connection) &&
         is_own_origin(header_of(connection, "Origin"), header_of(connection, "Host")) &&
         pages.size() < kMaxPages;
}

void Server::Impl::open(mg_connection* connection) {
  PageClient* page = nullptr;
  {
    const std::lock_guard lock(mutex);
    auto& client = pages[connection];
    client = std::make_unique<PageClient>(hub, connection);
    page = client.get();
  }
  handler.on_open(*page);
  page->start();
}

/// Whether the connection stays.
bool Server::Impl::read(mg_connection* connection, int bits, std::string_view text) {
  constexpr int kFinal = 0x80, kOpcode = 0x0f;
  const int opcode = bits & kOpcode;
  if (opcode == MG_WEBSOCKET_OPCODE_PING || opcode == MG_WEBSOCKET_OPCODE_PONG) return true;
  const bool is_whole_text = opcode == MG_WEBSOCKET_OPCODE_TEXT && (bits & kFinal) != 0;
  if (!is_whole_text || text.size() > kMaxText) return false;
  PageClient* page = nullptr;
  {
    const std::lock_guard lock(mutex);
    const auto found = pages.find(connection);
    if (found == pages.end()) return false;
    page = found->second.get();
  }
  handler.on_text(*page, text);
  return true;
}

void Server::Impl::close(const mg_connection* connection) {
  std::unique_ptr<PageClient> page;
  {
    const std::lock_guard lock(mutex);
    const auto found = pages.find(connection);
    if (found == pages.end()) return;
    page = std::move(found->second);
    pages.erase(found);
  }
  handler.on_close(*page);
}

Server::Server(Hub& hub, std::uint16_t port, PageHandler handler)
    : impl_(std::make_unique<Impl>(hub, std::move(handler))) {
  mg_init_library(MG_FEATURES_WEBSOCKET);
  const std::string address = "127.0.0.1:" + std::to_string(port);
  const std::array<const char*, 17> options{"listening_ports",
                                            address.c_str(),
                                            "num_threads",
                                            "24",
                                            "request_timeout_ms",
                                            "10000",
                                            "websocket_timeout_ms",
                                            "20000",
                                            "enable_websocket_ping_pong",
                                            "yes",
                                            "max_request_size",
                                            "8192",
                                            "tcp_nodelay",
                                            "1",
                                            "enable_directory_listing",
                                            "no",
                                            nullptr};
  mg_callbacks callbacks{};
  impl_->context = mg_start(&callbacks, impl_.get(), const_cast<const char**>(options.data()));
  if (impl_->context == nullptr) {
    throw ServerError("nothing can listen at http://" + address +
                      ": another program does, or a panel that runs already; choose --port");
  }
  mg_server_port bound{};
  if (mg_get_server_ports(impl_->context, 1, &bound) > 0) {
    impl_->port = static_cast<std::uint16_t>(bound.port);
  }
  Impl* const self = impl_.get();
  mg_set_request_handler(
      self->context, "/",
      [](mg_connection* connection, void* data) {
        return static_cast<Impl*>(data)->serve(connection);
      },
      self);
  mg_set_websocket_handler(
      self->context, "/live",
      [](const mg_connection* connection, void* data) {
        return static_cast<Impl*>(data)->admits(connection) ? 0 : 1;
      },
      [](mg_connection* connection, void* data) { static_cast<Impl*>(data)->open(connection); },
      [](mg_connection* connection, int bits, char* text, std::size_t size, void* data) {
        return static_cast<Impl*>(data)->read(connection, bits, {text, size}) ? 1 : 0;
      },
      [](const mg_connection* connection, void* data) {
        static_cast<Impl*>(data)->close(connection);
      },
      self);
}

Server::~Server() {
  impl_->hub.close();
  mg_stop(impl_->context);
  mg_exit_library();
}

std::uint16_t Server::port() const noexcept { return impl_->port; }

}  // namespace meridian::panel
