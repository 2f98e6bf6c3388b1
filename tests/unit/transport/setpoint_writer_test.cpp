// SPDX-License-Identifier: Apache-2.0
#include "service/transport/setpoint_writer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "service/transport/reader.hpp"
#include "support/heap_watch.hpp"
#include "support/private_domain.hpp"

namespace meridian::dds {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

SetpointSample sample_number(std::uint64_t cycle) {
  SetpointSample sample;
  sample.setpoint.cycle = cycle;
  sample.setpoint.due_ns = static_cast<std::int64_t>(1000 * cycle);
  for (std::size_t i = 0; i < kMaxJoints; ++i) {
    sample.setpoint.position[i] = 0.5 * static_cast<double>(cycle + i);
    sample.setpoint.velocity[i] = -0.25 * static_cast<double>(cycle + i);
  }
  sample.setpoint.line = static_cast<std::uint32_t>(cycle + 3);
  sample.setpoint.epoch = 7;
  sample.setpoint.flags = 3;
  sample.crc = static_cast<std::uint32_t>(cycle + 5);
  return sample;
}

/// Whether every field is that of sample_number(its cycle).
bool is_whole(const SetpointSample& got) {
  const SetpointSample want = sample_number(got.setpoint.cycle);
  return got.setpoint.due_ns == want.setpoint.due_ns &&
         got.setpoint.position == want.setpoint.position &&
         got.setpoint.velocity == want.setpoint.velocity &&
         got.setpoint.line == want.setpoint.line && got.setpoint.epoch == want.setpoint.epoch &&
         got.setpoint.flags == want.setpoint.flags && got.crc == want.crc;
}

TEST(SetpointWriter, EverySampleArrivesWholeThoughItsBytesAreUsedAgain) {
  const support::PrivateDomain domain;
  Participant participant({.domain = domain.id(), .machine = "m"});
  SetpointWriter writer(participant);
  Reader<SetpointSample> reader(participant);
  while (writer.matched_readers() == 0) {
    std::this_thread::sleep_for(milliseconds(2));
  }
  SetpointSample got;
  for (std::uint64_t cycle = 1; cycle <= 1000; ++cycle) {
    ASSERT_TRUE(writer.write(sample_number(cycle)));
    if (cycle % 3 != 0) {  // now and then the reader is late: it keeps the newest
      ASSERT_TRUE(reader.take(got)) << cycle;
      ASSERT_EQ(got.setpoint.cycle, cycle);
      ASSERT_TRUE(is_whole(got)) << cycle;
    }
  }
  EXPECT_EQ(writer.written_unprepared(), 0U);
}

/// Other topics of the same process, busy in ways that empty the common pool: large samples out,
/// small samples in.
class BusyTopics {
 public:
  explicit BusyTopics(Participant& participant)
      : statuses_(participant), actions_(participant), answers_(participant) {
    thread_ = std::thread([this] {
      Status status;
      status.message.assign(150, 'x');
      ActionDone done;
      for (std::uint64_t i = 0; !is_stopping_; ++i) {
        (void)statuses_.write(status);
        (void)answers_.write({.id = i, .service_id = 1, .is_done = true, .text = {}});
        while (actions_.take(done)) {
        }
        std::this_thread::yield();
      }
    });
  }
  ~BusyTopics() {
    is_stopping_ = true;
    thread_.join();
  }
  BusyTopics(const BusyTopics&) = delete;
  BusyTopics& operator=(const BusyTopics&) = delete;

 private:
  Writer<Status> statuses_;
  Reader<ActionDone> actions_;
  Writer<ActionDone> answers_;
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

TEST(SetpointWriter, MakesNoHeapCallWhateverOtherThreadsDoWithDds) {
  if (!watch::is_heap_watched()) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  const support::PrivateDomain domain;
  Participant participant({.domain = domain.id(), .machine = "m"});
  SetpointWriter writer(participant);
  const BusyTopics busy(participant);
  for (std::uint64_t cycle = 1; cycle <= 200; ++cycle) {
    ASSERT_TRUE(writer.write(sample_number(cycle)));
  }
  const watch::HeapWatch heap;
  for (std::uint64_t cycle = 201; cycle <= 20'000; ++cycle) {
    (void)writer.write(sample_number(cycle));
    if (cycle % 100 == 0) {
      std::this_thread::yield();
    }
  }
  const watch::HeapCalls calls = heap.calls();
  // A host that stalls this thread for longer than the lease is reported, not forgiven: see below.
  EXPECT_LE(calls.allocations, writer.lease_losses()) << "no lease was lost, so none may be made\n"
                                                      << watch::HeapWatch::callers(calls);
  EXPECT_EQ(calls.frees, 0U) << watch::HeapWatch::callers(calls);
  EXPECT_EQ(writer.written_unprepared(), 0U);
}

TEST(SetpointWriter, MakesNoHeapCallThoughOtherWritersKeepWhatItGaveBackToThePool) {
  if (!watch::is_heap_watched()) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  const support::PrivateDomain domain;
  Participant participant({.domain = domain.id(), .machine = "m"});
  SetpointWriter writer(participant);
  std::array<Writer<DriveCommand>, 4> keepers{
      // each keeps the newest sample of every drive
      Writer<DriveCommand>(participant), Writer<DriveCommand>(participant),
      Writer<DriveCommand>(participant), Writer<DriveCommand>(participant)};
  for (std::uint64_t cycle = 1; cycle <= 10; ++cycle) {
    ASSERT_TRUE(writer.write(sample_number(cycle)));
  }
  for (Writer<DriveCommand>& keeper : keepers) {
    for (int drive = 0; drive < 200; ++drive) {
      ASSERT_TRUE(keeper.write({.drive = static_cast<std::uint8_t>(drive)}));
    }
  }
  const watch::HeapWatch heap;
  for (std::uint64_t cycle = 11; cycle <= 20; ++cycle) {
    ASSERT_TRUE(writer.write(sample_number(cycle)));
  }
  const watch::HeapCalls calls = heap.calls();
  EXPECT_EQ(calls, (watch::HeapCalls{0, 0})) << watch::HeapWatch::callers(calls);
}

TEST(SetpointWriter, MakesOneHeapCallWhereItAnnouncesItselfAnewAfterItsLeaseRanOut) {
  if (!watch::is_heap_watched()) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  const support::PrivateDomain domain;
  Participant participant({.domain = domain.id(), .machine = "m"});
  SetpointWriter writer(participant);
  std::uint64_t cycle = 0;
  const auto write = [&](int count) {
    for (int n = 0; n < count; ++n) ASSERT_TRUE(writer.write(sample_number(++cycle)));
  };
  write(100);
  const std::uint64_t lost = writer.lease_losses();
  while (writer.lease_losses() == lost) std::this_thread::sleep_for(milliseconds(20));
  const watch::HeapWatch heap;
  write(1);
  EXPECT_EQ(heap.calls(), (watch::HeapCalls{1, 0}));
  write(100);
  EXPECT_LE(heap.calls().allocations, writer.lease_losses() - lost) << "one for each lease";
}

}  // namespace
}  // namespace meridian::dds
