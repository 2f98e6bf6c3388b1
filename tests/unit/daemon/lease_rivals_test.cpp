// SPDX-License-Identifier: Apache-2.0
#include "unit/daemon/lease_rivals.hpp"

#include <gtest/gtest.h>

#include "support/draws.hpp"

namespace meridian::interpolator::rivals {
namespace {

TEST(LeaseCheck, LeavesTheMachineToExactlyOneWhateverTheDelaysAndPauses) {
  for (std::uint32_t seed = 0; seed < static_cast<std::uint32_t>(test::draws(4000)); ++seed) {
    Rivals rivals(seed);
    const std::int64_t apart = std::vector<std::int64_t>{0, 200 * kMs, 5 * kS}[seed % 3];
    const int count = seed % 4 == 0 ? 3 : 2;
    for (int n = 1; n <= count; ++n) {
      rivals.add(static_cast<std::uint64_t>(n), 10 * kS + rivals.draw(0, apart / kMs) * kMs);
    }
    const std::int64_t max = rivals.draw(0, 100) * 10 * kMs;
    rivals.connect(0, max);
    for (auto& wires : rivals.wires) {
      for (Wire& wire : wires) {
        wire.min = seed % 5 == 0 ? max : rivals.draw(0, max / kMs) * kMs;
      }
    }
    rivals.forgets_the_paused = seed % 2 == 0;
    for (Rival& rival : rivals.rivals) {
      if (seed % 7 == 0) rival.off_from = 15 * kS + rivals.draw(0, 5000) * kMs;
      for (int n = 0; n < rivals.draw(0, 4); ++n) {
        const std::int64_t begin = 10 * kS + rivals.draw(0, 15'000) * kMs;
        rival.pauses.push_back({begin, begin + rivals.draw(0, 3000) * kMs});
      }
    }
    ASSERT_EQ(rivals.run(35 * kS).size(), 1U) << "seed " << seed;
  }
}

TEST(LeaseCheck, LeavesTheMachineToOneWhereBothWordsCameTooLateToShowWhoServedLonger) {
  Rivals rivals(1);
  rivals.add(2, 0);
  rivals.add(1, 50 * kMs).pauses = {{50 * kMs, 2 * kS}};
  rivals.rivals[0].pauses = {{0, 2 * kS}};
  rivals.connect(100 * kMs, 100 * kMs);
  EXPECT_EQ(rivals.run(10 * kS).size(), 1U);
}

TEST(LeaseCheck, LetsTheOneThatServedLongerKeepTheMachineWhateverItsNumberAndTheirClocks) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Rivals rivals(seed);
    const std::uint64_t older = 1 + seed % 2;
    const std::int64_t max = rivals.draw(0, 1000) * kMs;
    rivals.add(older, 0);
    rivals.add(3 - older, LeaseCheck::kSame_ns + max + rivals.draw(150, 20'000) * kMs);
    rivals.connect(0, max);
    EXPECT_EQ(rivals.run(15 * kS), std::vector{older}) << "seed " << seed;
  }
}

TEST(LeaseCheck, LetsTheOneThatServedMuchLongerKeepTheMachineWhoeverIsPaused) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Rivals rivals(seed);
    const std::uint64_t older = 1 + seed % 2;
    const std::int64_t begin = 10 * kS;
    rivals.add(older, 0);
    rivals.add(3 - older, begin);
    rivals.connect(0, kS);
    for (Rival& rival : rivals.rivals) {
      const std::int64_t from = begin + rivals.draw(0, 3000) * kMs;
      rival.pauses = {{from, from + rivals.draw(0, 3000) * kMs}};
    }
    EXPECT_EQ(rivals.run(20 * kS), std::vector{older}) << "seed " << seed;
  }
}

TEST(LeaseCheck, LetsTheSmallerNumberKeepTheMachineWhereBothServedForAsLong) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Rivals rivals(seed);
    rivals.add(1, seed % 2 * 40 * kMs);
    rivals.add(2, (1 - seed % 2) * 40 * kMs);
    rivals.connect(0, rivals.draw(0, 1000) * kMs);
    EXPECT_EQ(rivals.run(9 * kS), std::vector<std::uint64_t>{1}) << "seed " << seed;
  }
}

TEST(LeaseCheck, KeepsAMachineThatMovesThoughAnotherOneServedLongerAndLeavesItOnceItRests) {
  for (const std::uint64_t older : {1U, 2U}) {
    Rivals rivals(3);
    rivals.add(older, 0);
    Rival& moving = rivals.add(3 - older, 10 * kS);
    moving.off_from = 20 * kS;
    rivals.connect(0, 20 * kMs);
    EXPECT_EQ(rivals.run(15 * kS), std::vector{older});
    EXPECT_GE(moving.left, 20 * kS + LeaseCheck::kStepBack_ns);
  }
}

}  // namespace
}  // namespace meridian::interpolator::rivals
