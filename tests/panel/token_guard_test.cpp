// SPDX-License-Identifier: Apache-2.0
#include "service/panel/desks/token_guard.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

namespace meridian::panel {
namespace {

using namespace std::chrono_literals;

const std::string kToken = "0123456789abcdef0123456789abcdef";

[[nodiscard]] std::string token_file(const std::string& text, ::mode_t mode = 0600) {
  const auto path =
      std::filesystem::path(testing::TempDir()) / ("token-" + std::to_string(::getpid()) + ".txt");
  std::ofstream(path) << text;
  ::chmod(path.c_str(), mode);
  return path.string();
}

[[nodiscard]] std::string refusal(const std::string& path) {
  try {
    static_cast<void>(load_token(path));
  } catch (const TokenError& error) {
    return error.what();
  }
  return "";
}

[[nodiscard]] std::string cookie_of(const TokenGuard& guard, std::uint16_t port) {
  const std::string header = guard.session_cookie(port, true);
  const std::string begin = "Set-Cookie: ";
  return header.substr(begin.size(), header.find(';') - begin.size());
}

TEST(TokenFile, IsOneWordThatItsOwnerAloneMayRead) {
  EXPECT_EQ(load_token(token_file(kToken + "\n")), kToken);
  EXPECT_NE(refusal(token_file(kToken, 0640)).find("chmod 600"), std::string::npos);
  EXPECT_NE(refusal(token_file("short\n")).find("at least 32"), std::string::npos);
  EXPECT_NE(refusal(token_file(kToken + " two\n")).find("one word"), std::string::npos);
  EXPECT_NE(refusal("/no/such/file").find("openssl rand"), std::string::npos);
}

TEST(TokenGuard, TakesItsTokenAndNoOther) {
  TokenGuard guard(kToken);
  const auto now = TokenGuard::Clock::now();
  EXPECT_EQ(guard.check(kToken, now), TokenCheck::kRight);
  EXPECT_EQ(guard.check("", now), TokenCheck::kWrong);
  EXPECT_EQ(guard.check(kToken + "0", now), TokenCheck::kWrong);
  EXPECT_EQ(guard.check(kToken.substr(1) + "0", now), TokenCheck::kWrong);
}

TEST(TokenGuard, AfterTooManyWrongTokensEvenTheRightOneWaits) {
  TokenGuard guard(kToken);
  const auto now = TokenGuard::Clock::now();
  for (int n = 0; n < TokenGuard::kMaxWrong; ++n) {
    EXPECT_EQ(guard.check("wrong", now), TokenCheck::kWrong);
  }
  EXPECT_EQ(guard.check(kToken, now + 1s), TokenCheck::kTooMany);
  EXPECT_EQ(guard.check(kToken, now + TokenGuard::kWindow + 1s), TokenCheck::kRight);
}

TEST(TokenGuard, KnowsItsSessionAmongOtherCookies) {
  const TokenGuard guard(kToken);
  const std::string cookie = cookie_of(guard, 8090);
  EXPECT_TRUE(guard.has_session(cookie, 8090));
  EXPECT_TRUE(guard.has_session("theme=dark; " + cookie + "; a=b", 8090));
  EXPECT_FALSE(guard.has_session(cookie, 8091)) << "a session of another panel of this host";
  EXPECT_FALSE(guard.has_session(cookie + "0", 8090));
  EXPECT_FALSE(guard.has_session("x" + cookie, 8090));
  EXPECT_FALSE(guard.has_session("", 8090));
  EXPECT_FALSE(guard.has_session(cookie.substr(0, cookie.find('=') + 1), 8090));
}

TEST(TokenGuard, EveryPanelHasASessionOfItsOwn) {
  const TokenGuard one(kToken), other(kToken);
  EXPECT_FALSE(other.has_session(cookie_of(one, 8090), 8090));
}

TEST(TokenGuard, TheSessionIsOutOfReachOfScriptsAndOtherSites) {
  const TokenGuard guard(kToken);
  const std::string secured = guard.session_cookie(8090, true);
  for (const char* const attribute : {"HttpOnly", "SameSite=Strict", "Secure", "Path=/"}) {
    EXPECT_NE(secured.find(attribute), std::string::npos) << attribute;
  }
  EXPECT_EQ(guard.session_cookie(8090, false).find("Secure"), std::string::npos);
  EXPECT_EQ(secured.find(kToken), std::string::npos) << "the token itself stays at home";
}

}  // namespace
}  // namespace meridian::panel
