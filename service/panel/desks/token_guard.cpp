// SPDX-License-Identifier: Apache-2.0
#include "service/panel/desks/token_guard.hpp"

#include <sys/random.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <utility>

#include "service/text/whole_file.hpp"

namespace meridian::panel {
namespace {

constexpr const char* kHowToMakeToken = "; make one with: (umask 077; openssl rand -hex 32 > FILE)";

/// Takes as long for a word that differs at its first character as for one that is equal; how long
/// the token is is no secret.
[[nodiscard]] bool is_equal_in_constant_time(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  volatile unsigned char difference = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    difference = static_cast<unsigned char>(difference | (a[n] ^ b[n]));
  }
  return difference == 0;
}

[[nodiscard]] std::string random_word() {
  std::array<unsigned char, 32> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw TokenError("the system gives no random numbers, so no session can be made");
  }
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string word;
  for (const unsigned char byte : bytes) {
    word += kDigits[byte >> 4];
    word += kDigits[byte & 15];
  }
  return word;
}

[[nodiscard]] std::string cookie_name(std::uint16_t port) {  // browsers keep one jar for all ports
  return "meridian-panel-" + std::to_string(port);
}

}  // namespace

std::string load_token(const std::string& path) {
  constexpr ::mode_t kOthers = S_IRWXG | S_IRWXO;
  struct ::stat file {};
  if (::stat(path.c_str(), &file) != 0) {
    throw TokenError("no token file " + path + kHowToMakeToken);
  }
  if ((file.st_mode & kOthers) != 0) {
    throw TokenError("others may read the token file " + path + ": chmod 600 " + path);
  }
  auto token = text::read_whole(path);
  if (!token) throw TokenError("the token file " + path + " cannot be read");
  while (!token->empty() && (token->back() == '\n' || token->back() == '\r')) token->pop_back();
  const bool is_visible = std::all_of(token->begin(), token->end(),
                                      [](unsigned char c) { return c > ' ' && c < 0x7f; });
  if (token->size() < kMinTokenLength || !is_visible) {
    throw TokenError("the token file " + path + " has to hold one word of at least " +
                     std::to_string(kMinTokenLength) + " visible characters" + kHowToMakeToken);
  }
  return *std::move(token);
}

TokenGuard::TokenGuard(std::string token) : token_(std::move(token)), session_(random_word()) {}

TokenCheck TokenGuard::check(std::string_view shown, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (now - window_begin_ > kWindow) {
    wrong_ = 0;
    window_begin_ = now;
  }
  if (wrong_ >= kMaxWrong) return TokenCheck::kTooMany;
  if (is_equal_in_constant_time(shown, token_)) return TokenCheck::kRight;
  ++wrong_;
  return TokenCheck::kWrong;
}

bool TokenGuard::has_session(std::string_view cookies, std::uint16_t port) const {
  const std::string name = cookie_name(port) + '=';
  while (!cookies.empty()) {
    const std::size_t end = std::min(cookies.find(';'), cookies.size());
    std::string_view cookie = cookies.substr(0, end);
    cookie.remove_prefix(std::min(cookie.find_first_not_of(' '), cookie.size()));
    if (cookie.starts_with(name) &&
        is_equal_in_constant_time(cookie.substr(name.size()), session_)) {
      return true;
    }
    cookies.remove_prefix(std::min(end + 1, cookies.size()));
  }
  return false;
}

std::string TokenGuard::session_cookie(std::uint16_t port, bool is_secured) const {
  return "Set-Cookie: " + cookie_name(port) + '=' + session_ +
         "; Path=/; HttpOnly; SameSite=Strict" + (is_secured ? "; Secure" : "") + "\r\n";
}

}  // namespace meridian::panel
