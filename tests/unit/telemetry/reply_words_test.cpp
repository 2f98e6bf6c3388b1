// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/reply_words.hpp"

#include <gtest/gtest.h>

#include "meridian/cycle/state_table.hpp"
#include "support/machines.hpp"

namespace meridian::telemetry {
namespace {

/// A refusal of the machine of the tests.
std::string refused(Verb verb, Refusal refusal, State state, double argument = 0) {
  return describe(verb, refusal, state, argument, test::lai_machine());
}

TEST(ReplyWords, NameTheRemedyWithEveryRefusal) {
  constexpr int kLast = static_cast<int>(Refusal::kGuardOpen);
  for (int refusal = 1; refusal <= kLast; ++refusal) {
    EXPECT_STRNE(name_of(static_cast<Refusal>(refusal)), "unknown") << refusal;
    for (int state = 0; state < kStateCount; ++state) {
      const std::string text =
          refused(Verb::kStart, static_cast<Refusal>(refusal), static_cast<State>(state));
      EXPECT_EQ(text.rfind("start refused: ", 0), 0U);
      EXPECT_GT(text.size(), std::string("start refused: ").size() + 10) << text;
    }
  }
  EXPECT_EQ(refused(Verb::kStart, static_cast<Refusal>(kLast + 1), State::kOff), "start refused: ")
      << "there are more";
}

TEST(ReplyWords, NameTheValueThatIsSet) {
  EXPECT_EQ(describe(Verb::kFeedOverride, State::kRunning, 0.8), "feed_override set to 80 %");
  EXPECT_EQ(describe(Verb::kRapidOverride, State::kOff, 0.125), "rapid_override set to 12.5 %");
  EXPECT_EQ(describe(Verb::kSingleBlock, State::kReady, 1),
            "single_block on; the machine is Ready");
  EXPECT_EQ(describe(Verb::kOptionalStop, State::kReady, 0),
            "optional_stop off; the machine is Ready");
  EXPECT_EQ(describe(Verb::kEnable, State::kEnabling, 0),
            "enable accepted; the machine is Enabling");
}

TEST(ReplyWords, NameTheValueThatIsOutOfItsRangeAndTheRange) {
  MachineModel model = test::lai_machine();
  model.max_feed_override = 1.5;
  EXPECT_EQ(describe(Verb::kFeedOverride, Refusal::kOutOfRange, State::kRunning, 2, model),
            "feed_override refused: 200 % is out of range: from 0 to 150 % "
            "(feed_override_max_percent of the machine file)");
  EXPECT_EQ(describe(Verb::kRapidOverride, Refusal::kOutOfRange, State::kRunning, 1.01, model),
            "rapid_override refused: 101 % is out of range: from 0 to 100 %");
  EXPECT_EQ(refused(Verb::kSingleBlock, Refusal::kOutOfRange, State::kReady, 7),
            "single_block refused: 7 is out of range: on or off");
  EXPECT_EQ(refused(Verb::kEnable, Refusal::kOutOfRange, State::kOff, 3),
            "enable refused: 3 is out of range: 1 for a dry run alone, else 0");
  EXPECT_EQ(refused(Verb::kJog, Refusal::kOutOfRange, State::kReady, 9),
            "jog refused: the machine has no such joint");
}

TEST(ReplyWords, NameWhereTheDryRunMayBeSwitchedAndWhatIsSaidForNone) {
  EXPECT_EQ(
      refused(Verb::kDryRun, Refusal::kWrongState, State::kRunning),
      "dry_run refused: not in state Running; it begins and ends in Off alone; disable first");
  EXPECT_EQ(refused(Verb::kStart, Refusal::kNotDryRun, State::kLoaded, 1),
            "start refused: it was said for a dry run alone, and this is none: drives would move; "
            "disable, then dry-run on");
}

}  // namespace
}  // namespace meridian::telemetry
