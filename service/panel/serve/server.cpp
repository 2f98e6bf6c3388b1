// SPDX-License-Identifier: Apache-2.0
#include "service/panel/serve/server.hpp"

#include <civetweb.h>

#include <array>
#include <charconv>
#include <exception>
#include <map>
#include <mutex>
#include <utility>

#include "service/panel/desks/request_guard.hpp"
#include "service/panel/desks/token_guard.hpp"
#include "service/panel/page.hpp"
#include "service/panel/serve/http.hpp"
#include "service/panel/serve/login_page.hpp"
#include "service/panel/serve/page_client.hpp"

namespace meridian::panel {
namespace {

[[nodiscard]] const char* status_line(int status) {
  switch (status) {
    case 200:
      return "200 OK";
    case 403:
      return "403 Forbidden";
    case 503:
      return "503 Service Unavailable";
    default:
      return "409 Conflict";
  }
}

}  // namespace

struct Server::Impl {
  Impl(Hub& shared, PageHandler page_handler) : hub(shared), handler(std::move(page_handler)) {}

  [[nodiscard]] bool is_from_here(const mg_connection* connection) const {
    return is_own_host(http::header_of(connection, "Host"), site);
  }
  /// A browser says where a POST or a WebSocket comes from: a page of another site is refused.
  [[nodiscard]] bool is_from_own_page(const mg_connection* connection) const {
    return is_own_origin(http::header_of(connection, "Origin"), http::header_of(connection, "Host"),
                         site);
  }
  [[nodiscard]] bool is_known(const mg_connection* connection);
  void ask_for_token(mg_connection* connection, std::string_view path) const;
  void log_in(mg_connection* connection);
  void serve(mg_connection* connection);
  /// The same; what goes wrong within is answered, for the server is written in C.
  void serve_or_fail(mg_connection* connection) noexcept;
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
  Site site;
  std::optional<TokenGuard> tokens;  ///< none: nobody is asked
  std::mutex mutex;
  std::map<const mg_connection*, std::unique_ptr<PageClient>> pages;
};

/// Whether the request is of somebody who has shown the token: a browser with its session, or a
/// program that shows it each time.
bool Server::Impl::is_known(const mg_connection* connection) {
  constexpr std::string_view kBearer = "Bearer ";
  if (!tokens || tokens->has_session(http::header_of(connection, "Cookie"), site.port)) return true;
  const std::string_view shown = http::header_of(connection, "Authorization");
  return shown.starts_with(kBearer) &&
         tokens->check(shown.substr(kBearer.size()), TokenGuard::Clock::now()) ==
             TokenCheck::kRight;
}

void Server::Impl::ask_for_token(mg_connection* connection, std::string_view path) const {
  if (path == "/" || path == "/login") return answer_login(connection, "401 Unauthorized", "");
  if (const auto style = find_page_file(path); style && path == "/panel.css") {
    return http::answer(connection, "200 OK", style->bytes, {style->type, style->is_gzip});
  }
  http::answer(connection, "401 Unauthorized", "show the token of this panel\n",
               {.headers = "WWW-Authenticate: Bearer\r\n"});
}

void Server::Impl::log_in(mg_connection* connection) {
  constexpr long long kMaxForm = 1024;
  if (!is_from_own_page(connection)) {
    return http::answer(connection, "403 Forbidden", "this is no page of the panel\n");
  }
  const std::string form = http::read_body(connection, kMaxForm);
  switch (tokens->check(http::find_variable(form, "token"), TokenGuard::Clock::now())) {
    case TokenCheck::kRight: {
      const bool is_secured = is_public_host(http::header_of(connection, "Host"), site);
      const std::string headers = tokens->session_cookie(site.port, is_secured) + "Location: /\r\n";
      return http::answer(connection, "303 See Other", "", {.headers = headers});
    }
    case TokenCheck::kWrong:
      return answer_login(connection, "401 Unauthorized", "This is not the token of this panel.");
    case TokenCheck::kTooMany:
      return answer_login(connection, "429 Too Many Requests",
                          "Too many wrong tokens. Wait half a minute, then try again.");
  }
}

void Server::Impl::serve(mg_connection* connection) {
  const mg_request_info* const request = mg_get_request_info(connection);
  const std::string_view method = request->request_method;
  const std::string_view path = request->local_uri != nullptr ? request->local_uri : "";
  if (!is_from_here(connection)) {
    http::answer(connection, "403 Forbidden", "this is no name of the panel's host\n");
  } else if (method == "POST" && path == "/login" && tokens) {
    log_in(connection);
  } else if (!is_known(connection)) {
    ask_for_token(connection, path);
  } else if (method == "POST" && path == "/program" && handler.upload) {
    upload(connection);
  } else if (method != "GET" && method != "HEAD") {
    http::answer(connection, "405 Method Not Allowed", "GET and HEAD alone\n");
  } else if (path == "/metrics" && handler.metrics) {
    http::answer(connection, "200 OK", handler.metrics(),
                 {.type = "text/plain; version=0.0.4; charset=utf-8"});
  } else if (const auto file = find_page_file(path)) {
    http::answer(connection, "200 OK", file->bytes, {file->type, file->is_gzip});
  } else if (http::header_of(connection, "Sec-Fetch-Site") == "cross-site") {
    // A browser says so: what another site's page asks for costs this host time.
    http::answer(connection, "403 Forbidden", "this is no page of the panel\n");
  } else if (const auto found = get(connection, path)) {
    http::answer(connection, status_line(found->status), found->text, {.type = found->type});
  } else {
    http::answer(connection, "404 Not Found", "the panel has no such page\n");
  }
}

void Server::Impl::serve_or_fail(mg_connection* connection) noexcept {
  try {
    serve(connection);
  } catch (const std::exception&) {
    mg_send_http_error(connection, 500, "%s", "the panel cannot answer that now");
  }
}

std::optional<HttpAnswer> Server::Impl::get(const mg_connection* connection,
                                            std::string_view path) const {
  if (!handler.get) return std::nullopt;
  const std::string_view query = http::query_of(connection);
  return handler.get({path, [query](const char* name) -> std::uint64_t {
                        const std::string value = http::find_variable(query, name);
                        std::uint64_t number = 0;
                        std::from_chars(value.data(), value.data() + value.size(), number);
                        return number;
                      }});
}

void Server::Impl::upload(mg_connection* connection) {
  const long long bytes = mg_get_request_info(connection)->content_length;
  if (!is_from_own_page(connection)) {
    return http::answer(connection, "403 Forbidden", "this is no page of the panel\n");
  }
  if (bytes < 0) {
    return http::answer(connection, "411 Length Required", "how long is the file?\n");
  }
  const std::string_view query = http::query_of(connection);
  HttpUpload upload;
  upload.key = http::find_variable(query, "key");
  upload.name = http::find_variable(query, "name");
  upload.bytes = static_cast<std::uint64_t>(bytes);
  upload.read = [connection](char* buffer, std::size_t size) -> std::int64_t {
    return mg_read(connection, buffer, size);
  };
  const HttpAnswer done = handler.upload(upload);
  http::answer(connection, status_line(done.status), done.text, {.type = done.type});
}

bool Server::Impl::admits(const mg_connection* connection) {
  if (!is_from_here(connection) || !is_from_own_page(connection) || !is_known(connection)) {
    return false;
  }
  const std::lock_guard lock(mutex);
  return pages.size() < kMaxPages;
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

Server::Server(Hub& hub, ServerOptions options, PageHandler handler)
    : impl_(std::make_unique<Impl>(hub, std::move(handler))) {
  impl_->site = {options.port, std::move(options.public_host)};
  if (!options.token.empty()) impl_->tokens.emplace(std::move(options.token));
  if (!impl_->site.public_host.empty() && !impl_->tokens) {
    throw ServerError("a panel that is reached from elsewhere asks for a token: --token FILE");
  }
  mg_init_library(MG_FEATURES_WEBSOCKET);
  const std::string address = "127.0.0.1:" + std::to_string(options.port);
  const std::array<const char*, 17> settings{"listening_ports",
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
  impl_->context = mg_start(&callbacks, impl_.get(), const_cast<const char**>(settings.data()));
  if (impl_->context == nullptr) {
    throw ServerError("nothing can listen at http://" + address +
                      ": another program does, or a panel that runs already; choose --port");
  }
  mg_server_port bound{};
  if (mg_get_server_ports(impl_->context, 1, &bound) > 0) {
    impl_->site.port = static_cast<std::uint16_t>(bound.port);
  }
  Impl* const self = impl_.get();
  mg_set_request_handler(
      self->context, "/",
      [](mg_connection* connection, void* data) {
        static_cast<Impl*>(data)->serve_or_fail(connection);
        return 1;
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

std::uint16_t Server::port() const noexcept { return impl_->site.port; }

}  // namespace meridian::panel
