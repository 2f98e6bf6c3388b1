// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <idl/cl.h>
#include <idl/drives.h>
#include <idl/operator.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <set>
#include <thread>

#include "service/transport/convert/messages.hpp"
#include "service/transport/followed.hpp"
#include "service/transport/latency_since.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/waitset.hpp"
#include "service/transport/writer.hpp"
#include "support/heap_watch.hpp"
#include "support/private_domain.hpp"

namespace meridian::dds {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

template <class Condition>
bool eventually(Condition condition) {
  const auto end = Clock::now() + milliseconds(5000);
  while (Clock::now() < end) {
    if (condition()) return true;
    std::this_thread::sleep_for(milliseconds(2));
  }
  return false;
}

TEST(Exchange, DeliversEverySampleOfAStreamInOrder) {
  const support::PrivateDomain domain;
  Participant sender({.domain = domain.id(), .machine = "m"});
  Participant receiver({.domain = domain.id(), .machine = "m"});
  Writer<Batch> writer(sender);
  Reader<Batch> reader(receiver);
  Waitset waitset(receiver);
  waitset.attach(reader);
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1; }));
  for (std::uint64_t i = 0; i < 50; ++i) {
    Batch batch;
    batch.first_sequence = i;
    ASSERT_TRUE(writer.write(batch));
  }
  Batch batch;
  for (std::uint64_t i = 0; i < 50;) {
    if (!reader.take(batch)) {
      waitset.wait(milliseconds(1000));
      continue;
    }
    EXPECT_EQ(batch.first_sequence, i++);
  }
}

TEST(Exchange, GivesALateJoinerTheNewestOfEveryInstance) {
  const support::PrivateDomain domain;
  Participant participant({.domain = domain.id(), .machine = "m"});
  Writer<DriveCommand> writer(participant);
  for (std::uint16_t word = 6; word < 16; ++word) {
    for (std::uint8_t drive = 0; drive < 5; ++drive) {
      ASSERT_TRUE(writer.write({.drive = drive, .controlword = word}));
    }
  }
  Participant late({.domain = domain.id(), .machine = "m"});
  Reader<DriveCommand> reader(late);
  int seen = 0;
  DriveCommand command;
  EXPECT_TRUE(eventually([&] {
    while (reader.take(command)) {
      EXPECT_EQ(command.controlword, 15);
      ++seen;
    }
    return seen == 5;
  }));
}

TEST(Exchange, GivesAReaderOfTheNewestWhatComesNextAndNothingThatWas) {
  const support::PrivateDomain domain;
  Participant participant({.domain = domain.id(), .machine = "m"});
  Writer<Status> writer(participant);
  Status status;
  status.status_sequence = 1;
  ASSERT_TRUE(writer.write(status));
  Participant late({.domain = domain.id(), .machine = "m"});
  Reader<Status> reader(late, {}, 0, Delivery::kNewest);
  Status seen;
  ASSERT_TRUE(eventually([&] {
    ++status.status_sequence;
    return writer.write(status) && reader.take(seen);
  }));
  EXPECT_GT(seen.status_sequence, 1U);
}

/// Resident memory of this process, kB.
long resident_kB() {
  long total = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> total >> resident;
  return resident * (::sysconf(_SC_PAGESIZE) / 1024);
}

TEST(Exchange, KeepsNothingOfSessionsThatAreOver) {
  constexpr std::uint64_t kWarmUp = 4000, kSessions = 20'000;
  constexpr long kGrowth_kB = 1000;  // 0.05 kB a session; with a key to forget it were 0.4 kB
  if (!watch::is_heap_watched()) GTEST_SKIP() << "the sanitizer keeps what was given back";
  const support::PrivateDomain domain;
  Participant stations({.domain = domain.id(), .machine = "m"});
  Participant service({.domain = domain.id(), .machine = "m"});
  Writer<SessionRequest> requests(stations);
  Reader<SessionRequest> asked(service);
  Writer<Credit> credits(service);
  Reader<Credit> heard(stations);
  ASSERT_TRUE(eventually(
      [&] { return requests.matched_readers() == 1 && credits.matched_readers() == 1; }));
  long before_kB = 0;
  SessionRequest request;
  Credit credit;
  SampleInfo info;
  for (std::uint64_t session = 1; session <= kWarmUp + kSessions; ++session) {
    if (session == kWarmUp) before_kB = resident_kB();
    ASSERT_TRUE(requests.write({.session = session, .station = "cam", .program = "part"}));
    ASSERT_TRUE(
        eventually([&] { return asked.take(request, info) && request.session == session; }));
    ASSERT_TRUE(credits.write({.session = session, .text = "opened"}));
    while (heard.take(credit, info)) continue;
  }
  EXPECT_LT(resident_kB() - before_kB, kGrowth_kB);
}

/// Cyclone never forgets an instance that a reader has not acknowledged to the end, not even when
/// its writer goes. Ids that anybody may draw are therefore no keys.
TEST(Exchange, HasNoKeyWhereAnybodyMayDrawTheId) {
  for (const dds_topic_descriptor_t* topic :
       {&meridian_wire_ClBatch_desc, &meridian_wire_ClSession_desc, &meridian_wire_ClCredit_desc,
        &meridian_wire_Command_desc, &meridian_wire_Reply_desc, &meridian_wire_Jog_desc,
        &meridian_wire_Enabling_desc, &meridian_wire_Feedback_desc, &meridian_wire_Action_desc,
        &meridian_wire_ActionDone_desc}) {
    EXPECT_EQ(topic->m_nkeys, 0U) << topic->m_typename;
  }
}

TEST(Exchange, KeepsMachinesOfOneDomainApart) {
  const support::PrivateDomain domain;
  Participant lathe({.domain = domain.id(), .machine = "lathe"});
  Participant mill({.domain = domain.id(), .machine = "mill"});
  Participant mill_too({.domain = domain.id(), .machine = "mill"});
  Writer<Status> writer(mill);
  Reader<Status> other(lathe);
  Reader<Status> same(mill_too);
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1; }));
  ASSERT_TRUE(writer.write({.status_sequence = 3}));
  Status status;
  EXPECT_TRUE(eventually([&] { return same.take(status); }));
  EXPECT_FALSE(other.take(status));
}

TEST(Exchange, KeepsTheClaimsOfTwoServicesApartThoughNobodyLooksInBetween) {
  const support::PrivateDomain domain;
  Participant here({.domain = domain.id(), .machine = "m"});
  Reader<MachineInfo> reader(here);
  Writer<MachineInfo> first(here);
  Writer<MachineInfo> second(here);
  ASSERT_TRUE(first.write({.service_id = 1, .is_serving = true}));
  ASSERT_TRUE(second.write({.service_id = 2}));
  std::set<std::uint64_t> claims;
  MachineInfo machine;
  while (reader.take(machine)) claims.insert(machine.service_id);
  EXPECT_EQ(claims, (std::set<std::uint64_t>{1, 2}));
}

TEST(Exchange, GivesALateJoinerTheStatusOfEveryService) {
  const support::PrivateDomain domain;
  Participant here({.domain = domain.id(), .machine = "m"});
  Writer<Status> first(here);
  Writer<Status> second(here);
  ASSERT_TRUE(first.write({.service_id = 1}));
  ASSERT_TRUE(second.write({.service_id = 2}));
  Participant late({.domain = domain.id(), .machine = "m"});
  Reader<Status> reader(late);
  std::set<std::uint64_t> services;
  Status status;
  EXPECT_TRUE(eventually([&] {
    while (reader.take(status)) services.insert(status.service_id);
    return services.size() == 2;
  }));
}

TEST(Exchange, FollowsOneServiceUntilItIsGoneWhateverOthersSayLater) {
  const support::PrivateDomain domain;
  Participant here({.domain = domain.id(), .machine = "m"});
  Reader<Status> reader(here);
  Followed<Status> followed;
  Status status;
  Writer<Status> second(here);
  {
    Writer<Status> first(here);
    ASSERT_TRUE(first.write({.service_id = 1}));
    ASSERT_TRUE(followed.take(reader, status));
    ASSERT_TRUE(second.write({.service_id = 2}));
    EXPECT_FALSE(followed.take(reader, status)) << "its clock may say anything";
    ASSERT_TRUE(first.write({.service_id = 1, .block = 5}));
    ASSERT_TRUE(second.write({.service_id = 2}));
    ASSERT_TRUE(followed.take(reader, status));
    EXPECT_EQ(status.block, 5U);
  }
  ASSERT_TRUE(second.write({.service_id = 2}));
  EXPECT_TRUE(followed.take(reader, status));
  EXPECT_EQ(status.service_id, 2U);
}

TEST(Exchange, LetsGoOfAServiceThatSaysNothingWhileAnotherSpeaksTenTimes) {
  const support::PrivateDomain domain;
  Participant here({.domain = domain.id(), .machine = "m"});
  Reader<Status> reader(here);
  Followed<Status> followed;
  Status status;
  Writer<Status> first(here);  // there all the time
  Writer<Status> second(here);
  ASSERT_TRUE(first.write({.service_id = 1}));
  ASSERT_TRUE(followed.take(reader, status));
  const auto say = [&](int times) {
    int taken = 0;
    for (int n = 0; n < times; ++n) {
      EXPECT_TRUE(second.write({.service_id = 2}));
      taken += followed.take(reader, status) ? 1 : 0;
    }
    return taken;
  };
  EXPECT_EQ(say(9), 0);
  ASSERT_TRUE(first.write({.service_id = 1}));
  ASSERT_TRUE(followed.take(reader, status));
  EXPECT_EQ(status.service_id, 1U);
  EXPECT_EQ(say(9), 0) << "it spoke in between: the count begins anew";
  EXPECT_EQ(say(3), 3);
  EXPECT_EQ(status.service_id, 2U);
}

TEST(Exchange, ReportsThatAWriterHasGone) {
  const support::PrivateDomain domain;
  Participant here({.domain = domain.id(), .machine = "m"});
  Reader<MachineInfo> reader(here);
  MachineInfo machine;
  SampleInfo info;
  {
    Participant there({.domain = domain.id(), .machine = "m"});
    Writer<MachineInfo> writer(there);
    ASSERT_TRUE(writer.write({.service_id = 9, .name = "lai"}));
    ASSERT_TRUE(eventually([&] { return reader.take(machine, info); }));
    EXPECT_EQ(machine.name, "lai");
    EXPECT_TRUE(reader.has_source(info.source));
  }
  EXPECT_TRUE(eventually([&] { return !reader.has_source(info.source); }));
}

TEST(Exchange, CallsTheListenerForCyclicSamples) {
  const support::PrivateDomain domain;
  Participant participant({.domain = domain.id(), .machine = "m"});
  std::atomic<std::uint64_t> newest{0};
  Reader<DriveFeedback> reader(participant, [&](Reader<DriveFeedback>& from) {
    DriveFeedback feedback;
    while (from.take(feedback)) newest = feedback.sample;
  });
  Writer<DriveFeedback> writer(participant);
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1; }));
  ASSERT_TRUE(writer.write({.sample = 1}));
  ASSERT_TRUE(writer.write({.sample = 2}));
  EXPECT_TRUE(eventually([&] { return newest == 2; }));
}

TEST(Exchange, WakesAWaitingThreadAtOnce) {
  const support::PrivateDomain domain;
  Participant participant({.domain = domain.id(), .machine = "m"});
  Waitset waitset(participant);
  waitset.wake();
  const auto start = Clock::now();
  waitset.wait(milliseconds(4000));
  EXPECT_LT(Clock::now() - start, milliseconds(2000));
}

TEST(LatencySince, CountsWhatOneServiceDidAndAllOfOneThatWasStartedAnew) {
  Latency begin, end;
  begin.service_id = end.service_id = 7;
  begin.histograms = {{"lateness", {}}};
  begin.histograms[0].histogram.record(10);
  end.histograms = begin.histograms;
  end.histograms[0].histogram.record(20);
  EXPECT_EQ(latency_since(begin, end).histograms[0].histogram.count(), 1U);
  EXPECT_EQ(latency_since(begin, end).histograms[0].histogram.max_ns(), 20);
  end.service_id = 8;
  EXPECT_EQ(latency_since(begin, end).histograms[0].histogram.count(), 2U);
}

}  // namespace
}  // namespace meridian::dds
