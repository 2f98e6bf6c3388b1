// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/ports/program_claim.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace meridian::interpolator {
namespace {

using Holder = ProgramClaim::Holder;

TEST(ProgramClaim, IsHeldByOneAtATime) {
  ProgramClaim claim;
  EXPECT_TRUE(claim.try_take(Holder::kSession));
  EXPECT_TRUE(claim.try_take(Holder::kSession)) << "its holder keeps it";
  EXPECT_FALSE(claim.try_take(Holder::kSetUp));
  claim.give_back(Holder::kSetUp);  // not its to give
  EXPECT_FALSE(claim.try_take(Holder::kSetUp));
  claim.give_back(Holder::kSession);
  EXPECT_TRUE(claim.try_take(Holder::kSetUp));
  EXPECT_FALSE(claim.try_take(Holder::kSession));
}

TEST(ProgramClaim, ShowsTheNextHolderWhatTheOneBeforeDid) {
  constexpr int kTurns = 2000;
  ProgramClaim claim;
  int guarded = 0;  // no atomic: the claim alone keeps the two apart
  const auto count = [&](Holder holder) {
    for (int n = 0; n < kTurns;) {
      if (!claim.try_take(holder)) {
        std::this_thread::yield();
        continue;
      }
      ++guarded;
      claim.give_back(holder);
      ++n;
    }
  };
  std::thread other(count, Holder::kSetUp);
  count(Holder::kSession);
  other.join();
  EXPECT_EQ(guarded, 2 * kTurns);
}

}  // namespace
}  // namespace meridian::interpolator
