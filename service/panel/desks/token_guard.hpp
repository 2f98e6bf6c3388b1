// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>

namespace meridian::panel {

/// A token file that cannot be used; the message says why and what to do.
class TokenError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The token of a file: its one line. Throws TokenError where others than its owner may read the
/// file, or the line is shorter than kMinTokenLength or has other than visible ASCII characters.
[[nodiscard]] std::string load_token(const std::string& path);

inline constexpr std::size_t kMinTokenLength = 32;  // of hexadecimal digits: 128 bits

/// What a request that shows a token gets.
enum class TokenCheck { kRight, kWrong, kTooMany };

/// Who may use the panel: who knows its token. A browser shows it once and gets the session, a
/// random word that lives as long as this object. Safe to call from several threads.
///
/// Wrong tokens are counted: kMaxWrong of them within kWindow, and until it has passed every token
/// is refused unread. Sessions go on meanwhile. Proof: tests/panel/token_guard_test.cpp.
class TokenGuard {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr int kMaxWrong = 5;
  static constexpr std::chrono::seconds kWindow{30};

  /// Throws TokenError where the system has no random numbers.
  explicit TokenGuard(std::string token);

  /// A token that somebody shows at `now`.
  [[nodiscard]] TokenCheck check(std::string_view shown, Clock::time_point now);
  /// Whether `cookies`, the header of a request to `port`, hold the session.
  [[nodiscard]] bool has_session(std::string_view cookies, std::uint16_t port) const;
  /// The header Set-Cookie that gives the session to a browser; `is_secured`: over TLS alone.
  [[nodiscard]] std::string session_cookie(std::uint16_t port, bool is_secured) const;

 private:
  std::string token_, session_;
  std::mutex mutex_;
  int wrong_ = 0;
  Clock::time_point window_begin_{};
};

}  // namespace meridian::panel
