// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/session_phase.hpp"

#include <gtest/gtest.h>

#include <array>

namespace meridian::stream {
namespace {

using enum SessionPhase;

struct Row {
  SessionPhase from;
  std::array<SessionPhase, kSessionEventCount> to;  ///< in the order of SessionEvent
};

constexpr std::array<Row, kSessionPhaseCount> kWalk = {{
    // Phase        kOpened            kEndMark           kRefused           kEndIsLost  kOver
    {kFree, {kOpen, kFree, kFree, kFree, kFree}},
    {kOpen, {kOpen, kComplete, kRefused, kRefused, kFree}},
    {kComplete, {kComplete, kComplete, kRefusedComplete, kRefused, kFree}},
    {kRefused, {kRefused, kRefused, kRefused, kRefused, kFree}},
    {kRefusedComplete, {kRefusedComplete, kRefusedComplete, kRefusedComplete, kRefused, kFree}},
}};

TEST(SessionPhases, EveryEventLeadsFromEveryPhaseWhereTheTableSays) {
  for (std::size_t n = 0; n < kWalk.size(); ++n) {
    ASSERT_EQ(static_cast<std::size_t>(kWalk[n].from), n) << "the table is in order and whole";
    for (std::size_t event = 0; event < kSessionEventCount; ++event) {
      EXPECT_EQ(phase_after(kWalk[n].from, static_cast<SessionEvent>(event)), kWalk[n].to[event])
          << "phase " << n << ", event " << event;
    }
  }
}

TEST(SessionPhases, OnlyAnOpenSessionAcceptsBlocks) {
  for (const Row& row : kWalk) EXPECT_EQ(is_accepting(row.from), row.from == kOpen);
}

TEST(SessionPhases, NoEventTakesTheEndMarkBackButItsLoss) {
  for (const Row& row : kWalk) {
    if (!has_end_mark(row.from)) continue;
    for (std::size_t event = 0; event < kSessionEventCount; ++event) {
      const auto which = static_cast<SessionEvent>(event);
      const bool is_kept = which != SessionEvent::kEndIsLost && which != SessionEvent::kOver;
      EXPECT_EQ(has_end_mark(row.to[event]), is_kept);
    }
  }
}

TEST(SessionPhases, ARefusedSessionStaysSoUntilItIsOver) {
  for (const Row& row : kWalk) {
    if (!is_refused(row.from)) continue;
    for (std::size_t event = 0; event < kSessionEventCount; ++event) {
      EXPECT_EQ(is_refused(row.to[event]), static_cast<SessionEvent>(event) != SessionEvent::kOver);
    }
  }
}

}  // namespace
}  // namespace meridian::stream
