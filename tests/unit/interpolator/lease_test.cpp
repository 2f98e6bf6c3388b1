// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/lease.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "support/private_domain.hpp"

namespace meridian::interpolator {
namespace {

using std::chrono::milliseconds;
using LeaseClock = std::chrono::steady_clock;

/// A service as far as it concerns another one.
struct Claimant {
  Claimant(std::uint32_t domain, std::uint64_t id)
      : participant({.domain = domain, .machine = "m"}), lease(participant, claim(id)) {}

  static dds::MachineInfo claim(std::uint64_t id) {
    dds::MachineInfo info;
    info.service_id = id;
    info.name = "m";
    return info;
  }

  dds::Participant participant;
  Lease lease;
};

/// Who of two that both serve gives way to the other, 0: nobody in time.
std::uint64_t who_gives_way(Claimant& one, Claimant& other, milliseconds patience) {
  const auto end = LeaseClock::now() + patience;
  while (LeaseClock::now() < end) {
    for (Claimant* const claimant : {&one, &other}) {
      const auto keeper = claimant->lease.find_keeper(true);
      if (keeper) return keeper->service_id == 1 ? 2 : 1;
    }
    std::this_thread::sleep_for(milliseconds(20));
  }
  return 0;
}

TEST(Lease, OfTwoThatServeTheOneThatServesLongerKeepsTheMachineWhateverItsNumber) {
  const support::PrivateDomain domain;
  Claimant older(domain.id(), 2);
  older.lease.hold();
  std::this_thread::sleep_for(milliseconds(700));
  Claimant later(domain.id(), 1);
  later.lease.hold();  // it did not hear of the other in time
  EXPECT_EQ(who_gives_way(older, later, milliseconds(10'000)), 1U);
  EXPECT_FALSE(older.lease.find_keeper(true));
}

TEST(Lease, OfTwoThatServeSinceTheSameTimeTheSmallerNumberKeepsTheMachine) {
  const support::PrivateDomain domain;
  Claimant one(domain.id(), 1), other(domain.id(), 2);
  other.lease.hold();
  one.lease.hold();
  EXPECT_EQ(who_gives_way(one, other, milliseconds(10'000)), 2U);
  EXPECT_FALSE(one.lease.find_keeper(true));
}

TEST(Lease, OfTwoThatStartTogetherTheLargerNumberWaits) {
  const support::PrivateDomain domain;
  Claimant one(domain.id(), 1), other(domain.id(), 2);
  const auto holder = other.lease.find_holder(milliseconds(400), milliseconds(400));
  ASSERT_TRUE(holder);
  EXPECT_EQ(holder->service_id, 1U);
  EXPECT_FALSE(one.lease.find_holder(milliseconds(100), milliseconds(1000)));
}

/// Nothing holds it back but its drives.
TEST(Lease, LeavesNoMachineWhoseDrivesAreOn) {
  const support::PrivateDomain domain;
  Claimant older(domain.id(), 1), moving(domain.id(), 2);
  older.lease.hold();
  std::this_thread::sleep_for(milliseconds(150));
  moving.lease.hold();
  const auto end =
      LeaseClock::now() + std::chrono::nanoseconds(LeaseJudge::kStepBack_ns) + milliseconds(300);
  while (LeaseClock::now() < end) {
    ASSERT_FALSE(older.lease.find_keeper(true));
    ASSERT_FALSE(moving.lease.find_keeper(false));
    std::this_thread::sleep_for(milliseconds(20));
  }
}

TEST(Lease, WaitsForAHolderThatIsAboutToLeave) {
  const support::PrivateDomain domain;
  auto holder = std::make_unique<Claimant>(domain.id(), 2);
  holder->lease.hold();
  Claimant next(domain.id(), 1);
  ASSERT_TRUE(next.lease.find_holder(milliseconds(400), milliseconds(0)))
      << "who holds it says so without being asked, and its number does not count any more";
  std::thread leaving([&holder] {
    std::this_thread::sleep_for(milliseconds(200));
    holder.reset();
  });
  EXPECT_FALSE(next.lease.find_holder(milliseconds(0), milliseconds(5000)));
  leaving.join();
}

TEST(Lease, ListensForAsLongAsTheStartWindowBeforeItTakesTheMachineForFree) {
  const support::PrivateDomain domain;
  Claimant next(domain.id(), 9);
  std::unique_ptr<Claimant> late;
  std::thread coming([&] {
    std::this_thread::sleep_for(milliseconds(150));
    late = std::make_unique<Claimant>(domain.id(), 1);
    late->lease.hold();
  });
  EXPECT_TRUE(next.lease.find_holder(milliseconds(1500), milliseconds(0)));
  coming.join();
}

}  // namespace
}  // namespace meridian::interpolator
