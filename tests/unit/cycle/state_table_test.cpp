// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/state_table.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/document_table.hpp"
#include "unit/cycle/state_table_text.hpp"

namespace meridian {
namespace {

TEST(StateTable, IsTheTableOfTheDocument) {
  test::expect_table_of_document(MERIDIAN_SOURCE_DIR "/docs/operating.md", "table",
                                 testing::state_table_text());
}

TEST(StateTable, StartsMotionFromLoadedAndFromBehindABlockAndFromNowhereElse) {
  for (int s = 0; s < kStateCount; ++s) {
    const auto state = static_cast<State>(s);
    const bool goes = effect_of(state, Verb::kStart).effect == Effect::kGo;
    EXPECT_EQ(goes, state == State::kLoaded || state == State::kStepping) << name_of(state);
  }
}

TEST(StateTable, NeverRefusesHoldOrAbortInMotion) {
  for (int s = 0; s < kStateCount; ++s) {
    const auto state = static_cast<State>(s);
    if (!is_on_path(state)) continue;
    EXPECT_NE(effect_of(state, Verb::kHold).effect, Effect::kRefused) << name_of(state);
    EXPECT_NE(effect_of(state, Verb::kAbort).effect, Effect::kRefused) << name_of(state);
  }
}

TEST(StateTable, LaysHandsOnAMachineThatIsReadyAndOnNoOther) {
  for (int s = 0; s < kStateCount; ++s) {
    const auto state = static_cast<State>(s);
    for (const Verb verb : {Verb::kJog, Verb::kHome}) {
      EXPECT_EQ(effect_of(state, verb).effect == Effect::kGo, state == State::kReady)
          << name_of(verb) << " in " << name_of(state);
    }
  }
  for (const State state : {State::kJogging, State::kHoming}) {
    EXPECT_EQ(effect_of(state, Verb::kHold).next, State::kAborting);
    EXPECT_EQ(effect_of(state, Verb::kAbort).next, State::kAborting);
    EXPECT_EQ(effect_of(state, Verb::kStart).effect, Effect::kRefused);
  }
}

TEST(StateTable, SetsSingleBlockAndOptionalStopInEveryState) {
  for (int s = 0; s < kStateCount; ++s) {
    for (const Verb verb : {Verb::kSingleBlock, Verb::kOptionalStop}) {
      EXPECT_EQ(effect_of(static_cast<State>(s), verb).effect, Effect::kSet);
    }
  }
}

TEST(StateTable, SetsTheDryRunInOffAlone) {
  for (int s = 0; s < kStateCount; ++s) {
    const auto state = static_cast<State>(s);
    EXPECT_EQ(effect_of(state, Verb::kDryRun).effect == Effect::kSet, state == State::kOff);
  }
}

TEST(StateTable, ChangesTheSetUpInOffAndReadyAlone) {
  for (int s = 0; s < kStateCount; ++s) {
    const auto state = static_cast<State>(s);
    const bool may = state == State::kOff || state == State::kReady;
    for (const Verb verb : {Verb::kFrame, Verb::kTool, Verb::kLimits}) {
      EXPECT_EQ(effect_of(state, verb).effect == Effect::kSet, may) << name_of(state);
    }
  }
}

TEST(StateTable, LeavesFaultOnlyByReset) {
  for (int v = 0; v < kVerbCount; ++v) {
    const auto verb = static_cast<Verb>(v);
    const VerbEffect effect = effect_of(State::kFault, verb);
    EXPECT_EQ(effect.effect == Effect::kGo, verb == Verb::kReset) << name_of(verb);
  }
  EXPECT_EQ(effect_of(State::kFault, Verb::kReset).next, State::kOff);
}

TEST(StateTable, SaysWhyWhereItRefuses) {
  for (int s = 0; s < kStateCount; ++s) {
    for (int v = 0; v < kVerbCount; ++v) {
      const VerbEffect cell = effect_of(static_cast<State>(s), static_cast<Verb>(v));
      EXPECT_EQ(cell.effect == Effect::kRefused, cell.refusal != Refusal::kNone);
    }
  }
}

}  // namespace
}  // namespace meridian
