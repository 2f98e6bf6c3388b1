// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "service/panel/jog_grip.hpp"
#include "service/panel/serve/operator_pages.hpp"
#include "service/panel/serve/page_message.hpp"

namespace meridian::panel {
namespace {

using namespace std::chrono_literals;
using Clock = JogGrip::Clock;

TEST(JogGrip, IsLetGoWhenThePageFallsSilent) {
  const auto begin = Clock::now();
  JogGrip grip(1, 7, begin);
  grip.beat(begin + 100ms);
  grip.check(begin + 240ms);
  EXPECT_FALSE(grip.is_let_go());
  grip.check(begin + 251ms);
  EXPECT_TRUE(grip.is_let_go());
}

TEST(JogGrip, ABeatThatComesTooLateDoesNotPressAgain) {
  const auto begin = Clock::now();
  JogGrip grip(1, 7, begin);
  grip.beat(begin + 400ms);  // the page was frozen meanwhile, and nobody looked
  EXPECT_TRUE(grip.is_let_go());
  grip.beat(begin + 410ms);
  EXPECT_TRUE(grip.is_let_go());
}

constexpr const char* kSeen =
    R"("seen":{"service":"12345678901234567890","epoch":3,"sequence":100})";

[[nodiscard]] std::string message(const std::string& members) {
  return "{" + members + "," + kSeen + "}";
}

TEST(PageMessage, SaysWhatWasSeen) {
  const auto read = read_page_message(message(R"("do":"feed_override","id":4,"argument":0.3)"));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->verb, Verb::kFeedOverride);
  EXPECT_EQ(read->argument, 0.3);
  EXPECT_EQ(read->seen.service_id, 12345678901234567890ULL);
  EXPECT_EQ(read->seen.epoch, 3);
  EXPECT_EQ(read->seen.status_sequence, 100U);
}

TEST(PageMessage, WhatIsNoMessageSaysNothing) {
  const std::vector<std::string> bad{
      "",
      "null",
      "[]",
      "{}",
      R"({"do":"start"})",
      R"({"do":"start","id":1,"argument":0})",  // saw nothing
      message(R"("do":"explode","id":1,"argument":0)"),
      message(R"("do":"jog","id":1,"argument":0)"),
      R"({"do":"check","id":1})",
      R"({"do":"check","id":1,"line":-4})",
      R"({"do":"check","id":1,"line":4294967296})",
      R"({"do":"load"})",
      message(R"("do":"start","id":-1,"argument":0)"),
      message(R"("do":"start","id":1,"argument":1e999)"),
      message(R"("do":"start","id":1,"argument":"0")"),
      message(R"("do":"jog","id":1,"tool":false,"joint":6,"velocity":1,"distance":0)"),
      message(R"("do":"jog","id":1,"tool":true,"joint":5,"velocity":1,"distance":0)"),
      message(R"("do":"jog","id":1,"tool":false,"joint":0,"velocity":1,"distance":-1)"),
      R"({"do":"start","id":1,"argument":0,"seen":{"service":"1x","epoch":3,"sequence":1}})",
      R"({"do":"start","id":1,"argument":0,"seen":{"service":"1","epoch":65536,"sequence":1}})",
      std::string(4000, '[')};
  for (const std::string& text : bad) EXPECT_FALSE(read_page_message(text)) << text;
}

class FakePage : public PageLink {
 public:
  void say(std::string text) override { said.push_back(std::move(text)); }
  /// The key that it was given.
  [[nodiscard]] std::string key() const {
    return nlohmann::json::parse(said.back()).value("key", "");
  }
  [[nodiscard]] bool was_sent(const std::string& part) const {
    for (const std::string& text : said) {
      if (text.find(part) != std::string::npos) return true;
    }
    return false;
  }
  std::vector<std::string> said;
};

/// Pages with a desk that writes down what it is asked.
class OperatorPagesTest : public testing::Test {
 protected:
  struct Asked {
    Verb verb;
    double argument;
    stream::Seen seen;
  };
  OperatorPages pages_{
      {[this](Verb verb, double argument, const stream::Seen& seen, const OnOutcome& on) {
         asked_.push_back({verb, argument, seen});
         on({true, "done"});
       },
       [this](const stream::JogPlan&, std::shared_ptr<JogGrip> grip, const OnOutcome&) {
         grips_.push_back(std::move(grip));
       },
       [this] { return newest_; },
       [this](const PageMessage& message) {
         served_.push_back(message);
         return Outcome{true, "checked"};
       }}};
  [[nodiscard]] static std::string jog(int id) {
    return message(R"("do":"jog","id":)" + std::to_string(id) +
                   R"(,"tool":false,"joint":0,"velocity":5,"distance":0)");
  }
  [[nodiscard]] static std::string ask(const std::string& verb) {
    return message(R"("do":")" + verb + R"(","id":1,"argument":0)");
  }
  std::vector<Asked> asked_;
  std::vector<std::shared_ptr<JogGrip>> grips_;
  std::vector<PageMessage> served_;
  std::uint64_t newest_ = 100;
  FakePage one_, two_;
};

TEST_F(OperatorPagesTest, ACommandQuotesWhatItsPageSaw) {
  pages_.open(one_);
  pages_.read(one_, ask("start"));
  ASSERT_EQ(asked_.size(), 1U);
  EXPECT_EQ(asked_[0].verb, Verb::kStart);
  EXPECT_EQ(asked_[0].seen.epoch, 3);
  EXPECT_TRUE(one_.was_sent("done"));
}

TEST_F(OperatorPagesTest, OnePageOperatesAndEveryPageStops) {
  pages_.open(one_);
  pages_.open(two_);
  pages_.read(one_, ask("enable"));
  pages_.read(two_, ask("start"));
  ASSERT_EQ(asked_.size(), 1U);
  EXPECT_TRUE(two_.was_sent("another page operates"));
  pages_.read(two_, ask("hold"));
  ASSERT_EQ(asked_.size(), 2U);
  EXPECT_EQ(asked_[1].verb, Verb::kHold);
}

TEST_F(OperatorPagesTest, AnotherPageTakesOverAndTheFirstIsNotified) {
  pages_.open(one_);
  pages_.open(two_);
  pages_.read(one_, ask("enable"));
  pages_.read(one_, jog(1));
  pages_.read(two_, R"({"do":"take_over","id":0})");
  EXPECT_TRUE(one_.was_sent("another"));
  ASSERT_EQ(grips_.size(), 1U);
  EXPECT_TRUE(grips_[0]->is_let_go());
  pages_.read(two_, ask("start"));
  EXPECT_EQ(asked_.size(), 2U);
}

TEST_F(OperatorPagesTest, APageThatIsClosedLetsGo) {
  pages_.open(one_);
  pages_.read(one_, jog(1));
  ASSERT_EQ(grips_.size(), 1U);
  EXPECT_FALSE(grips_[0]->is_let_go());
  pages_.close(one_);
  EXPECT_TRUE(grips_[0]->is_let_go());
}

TEST_F(OperatorPagesTest, BeatsOfAPressThatWasLetGoMoveNothing) {
  pages_.open(one_);
  pages_.read(one_, jog(1));
  pages_.read(one_, R"({"do":"release","id":1})");
  pages_.read(one_, jog(1));
  EXPECT_EQ(grips_.size(), 1U);
  EXPECT_TRUE(grips_[0]->is_let_go());
}

TEST_F(OperatorPagesTest, ALateBeatOfAnEarlierPressPressesNothing) {
  pages_.open(one_);
  pages_.read(one_, jog(2));
  pages_.read(one_, jog(1));
  EXPECT_EQ(grips_.size(), 1U);
}

TEST_F(OperatorPagesTest, ABeatOfAPageThatLagsLetsGo) {
  pages_.open(one_);
  pages_.read(one_, jog(1));
  newest_ = 111;
  pages_.read(one_, jog(1));
  EXPECT_TRUE(grips_[0]->is_let_go());
}

TEST_F(OperatorPagesTest, AProgramIsTheOperatorsAlone) {
  pages_.open(one_);
  pages_.open(two_);
  pages_.read(one_, R"({"do":"check","id":1,"line":120})");
  ASSERT_EQ(served_.size(), 1U);
  EXPECT_EQ(served_[0].kind, PageMessage::Kind::kCheck);
  EXPECT_EQ(served_[0].line, 120U);
  pages_.read(two_, R"({"do":"load","id":1})");
  EXPECT_EQ(served_.size(), 1U);
  EXPECT_TRUE(two_.was_sent("another page operates"));
}

TEST_F(OperatorPagesTest, ARequestBesideTheLinkNeedsTheKeyOfTheOperatorsPage) {
  pages_.open(one_);
  pages_.open(two_);
  EXPECT_FALSE(pages_.may_operate(std::string_view("")));
  EXPECT_FALSE(pages_.may_operate(std::string_view("0123456789abcdef0123456789abcdef")));
  EXPECT_NE(one_.key(), two_.key());
  EXPECT_TRUE(pages_.may_operate(std::string_view(one_.key())));
  EXPECT_FALSE(pages_.may_operate(std::string_view(two_.key())));
}

TEST_F(OperatorPagesTest, APageThatWasNeverOpenedSaysNothing) {
  pages_.read(one_, ask("start"));
  EXPECT_TRUE(asked_.empty());
}

}  // namespace
}  // namespace meridian::panel
