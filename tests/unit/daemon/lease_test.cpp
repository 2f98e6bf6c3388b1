// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/lease.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

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
std::uint64_t who_yields(Claimant& one, Claimant& other, milliseconds patience) {
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
  EXPECT_EQ(who_yields(older, later, milliseconds(10'000)), 1U);
  EXPECT_FALSE(older.lease.find_keeper(true));
}

TEST(Lease, OfTwoThatServeSinceTheSameTimeTheSmallerNumberKeepsTheMachine) {
  const support::PrivateDomain domain;
  Claimant one(domain.id(), 1), other(domain.id(), 2);
  other.lease.hold();
  one.lease.hold();
  EXPECT_EQ(who_yields(one, other, milliseconds(10'000)), 2U);
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
      LeaseClock::now() + std::chrono::nanoseconds(LeaseCheck::kStepBack_ns) + milliseconds(300);
  while (LeaseClock::now() < end) {
    ASSERT_FALSE(older.lease.find_keeper(true));
    ASSERT_FALSE(moving.lease.find_keeper(false));
    std::this_thread::sleep_for(milliseconds(20));
  }
}

/// A service that serves, and somebody who says what he likes on the machine topic.
struct Claimed {
  support::PrivateDomain domain;
  std::vector<std::string> reports;
  dds::Participant participant{{.domain = domain.id(), .machine = "m"}};
  Lease lease{participant, Claimant::claim(7),
              [this](const std::string& text) { reports.push_back(text); }};
  dds::Participant somebody{{.domain = domain.id(), .machine = "m"}};
  dds::Writer<dds::MachineInfo> claims{somebody};

  /// Whether the service is to leave within 3 s, the drives obeying `master`.
  bool leaves(const std::function<dds::MachineInfo(std::uint64_t)>& claim, std::uint64_t master) {
    lease.hold();
    const auto end = LeaseClock::now() + milliseconds(3000);
    for (std::uint64_t n = 1; LeaseClock::now() < end; ++n) {
      (void)claims.write(claim(n));
      if (lease.find_keeper(true, master)) return true;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return false;
  }
};

dds::MachineInfo served_for(std::uint64_t id, std::int64_t served_ns) {
  dds::MachineInfo info = Claimant::claim(id);
  info.is_serving = true;
  info.served_ns = served_ns;
  return info;
}

TEST(Lease, DoesNotLeaveForAClaimOfTheFarFutureAndReportsItOnce) {
  Claimed claimed;
  EXPECT_FALSE(claimed.leaves([](std::uint64_t) { return served_for(1, 1LL << 60U); }, 0));
  ASSERT_EQ(claimed.reports.size(), 1U);
  EXPECT_NE(claimed.reports[0].find("claims this machine implausibly"), std::string::npos)
      << claimed.reports[0];
}

TEST(Lease, DoesNotLeaveForAnyClaimWhileTheDrivesObeyIt) {
  constexpr std::int64_t kDay_ns = 86'400'000'000'000;
  Claimed claimed;
  EXPECT_FALSE(claimed.leaves([](std::uint64_t) { return served_for(1, kDay_ns); }, 7));
  EXPECT_TRUE(claimed.leaves([](std::uint64_t) { return served_for(1, kDay_ns); }, 0))
      << "nobody says whom the drives obey: who served longer keeps the machine";
}

TEST(Lease, HearsOneServiceOfOneWriterHoweverManyIdsItDraws) {
  Claimed claimed;
  EXPECT_FALSE(claimed.leaves([](std::uint64_t n) { return served_for(100 + n, 0); }, 0));
  EXPECT_TRUE(claimed.reports.empty()) << "no more than one at a time";
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
