// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "service/panel/serve/hub.hpp"

namespace meridian::panel {

/// The server could not start; the message says why and what to do.
class ServerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A page that is open.
class PageLink {
 public:
  virtual ~PageLink() = default;
  /// Puts `text` into the queue of this page; where it does not read, the oldest are dropped.
  virtual void say(std::string text) = 0;
};

/// What a request is answered with.
struct HttpAnswer {
  int status = 200;  ///< 200, 403, 409
  const char* type = "text/plain; charset=utf-8";
  std::string text;
};

/// A file that a page sends.
struct HttpUpload {
  std::string key, name;  ///< of the page, of the file
  std::uint64_t bytes = 0;
  std::function<std::int64_t(char* buffer, std::size_t size)> read;  ///< as read(2)
};

/// A path, and the numbers after it: ?first=1&count=40.
struct HttpQuery {
  std::string_view path;
  std::function<std::uint64_t(const char* name)> number;  ///< 0: not there
};

/// What a server does with what pages say. Called on threads of the server, of one page on one
/// thread at a time.
struct PageHandler {
  std::function<void(PageLink& page)> on_open = [](PageLink&) {};
  std::function<void(PageLink& page, std::string_view text)> on_text = [](PageLink&,
                                                                          std::string_view) {};
  std::function<void(PageLink& page)> on_close = [](PageLink&) {};  ///< `page` ends with the call
  std::function<std::string()> metrics;                             ///< GET /metrics; empty: none
  std::function<HttpAnswer(const HttpUpload&)> upload;              ///< POST /program; empty: none
  /// GET of anything but the page's own files; nothing: there is no such thing.
  std::function<std::optional<HttpAnswer>(const HttpQuery&)> get;
};

struct ServerOptions {
  std::uint16_t port = 0;   ///< of loopback; 0: any that is free
  std::string public_host;  ///< of a TLS proxy in front of it; empty: there is none
  std::string token;        ///< what browsers and programs have to show; empty: nothing
};

/// HTTP and WebSocket on loopback: the files of the page, and a link to each page that is open.
///
/// Requests whose Host is no name of this host, or whose Origin is another site, are refused: a
/// page of the web that the operator has open in another tab reaches nothing. With a token nobody
/// reaches more than the page that asks for it, and behind a public host there has to be one. Pages
/// get what the hub has, each from a thread of its own: one that does not read holds up no other.
/// At most kMaxPages. Proof: tests/panel/browser_test.mjs, tests/panel/token_test.mjs.
class Server {
 public:
  static constexpr int kMaxPages = 12;
  /// Longest text that a page may send.
  static constexpr std::size_t kMaxText = 4096;

  /// `hub` must live on. Throws ServerError and TokenError.
  Server(Hub& hub, ServerOptions options, PageHandler handler);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] std::uint16_t port() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meridian::panel
