// SPDX-License-Identifier: Apache-2.0
#include "service/transport/cyclone/stalled_reader.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "service/transport/convert/messages.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/writer.hpp"
#include "support/private_domain.hpp"

namespace meridian::dds {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

bool comes(const std::function<bool()>& condition) {
  const auto end = Clock::now() + milliseconds(5000);
  while (!condition()) {
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(milliseconds(5));
  }
  return true;
}

/// A process with a reader of replies that the test may stop; made before this process has DDS.
class OtherProcess {
 public:
  explicit OtherProcess(std::uint32_t domain) : id_(::fork()) {
    if (id_ != 0) return;
    {
      Participant participant({.domain = domain, .machine = "mill"});
      Reader<Reply> reader(participant);
      Reply reply;
      ::signal(SIGTERM, [](int) { is_leaving_ = 1; });
      while (is_leaving_ == 0) {
        while (reader.take(reply)) {
        }
        std::this_thread::sleep_for(milliseconds(1));
      }
    }
    ::_exit(0);
  }
  ~OtherProcess() {
    if (id_ < 0) return;
    ::kill(id_, SIGKILL);
    ::waitpid(id_, nullptr, 0);
  }
  void stop() const { ::kill(id_, SIGSTOP); }
  void go_on() const { ::kill(id_, SIGCONT); }
  /// Its participant says goodbye.
  void leave() {
    ::kill(id_, SIGTERM);
    ::waitpid(id_, nullptr, 0);
    id_ = -1;
  }
  [[nodiscard]] pid_t id() const { return id_; }

 private:
  static inline volatile std::sig_atomic_t is_leaving_ = 0;
  pid_t id_;
};

/// Whether `process` is who has not acknowledged all.
bool names(const Participant& participant, std::int32_t writer, const OtherProcess& process) {
  const auto unacknowledged = find_unacknowledged(participant, writer);
  const std::string who = "process " + std::to_string(process.id()) + " ";
  return unacknowledged && unacknowledged->who.find(who) != std::string::npos;
}

TEST(StallWatch, TakesReadersThatComeAndGoForNobodyWhoStalls) {
  StallWatch watch;
  const auto unacknowledged = [](std::string who) { return Unacknowledged{7, 9, std::move(who)}; };
  for (int second = 0; second < 10; ++second) {
    EXPECT_FALSE(
        watch.look(unacknowledged("process " + std::to_string(second)), second * kSecond_ns));
  }
  EXPECT_FALSE(watch.look(unacknowledged("process 9"), 10 * kSecond_ns)) << "1 s";
  EXPECT_TRUE(watch.look(unacknowledged("process 9"), 11 * kSecond_ns)) << "2 s";
  EXPECT_FALSE(watch.look(std::nullopt, 12 * kSecond_ns));
  EXPECT_FALSE(watch.look(unacknowledged("process 9"), 13 * kSecond_ns)) << "it had caught up";
}

TEST(StalledReaders, AreNamedWithTheirProcessAndHoldBackNoWrite) {
  const support::PrivateDomain domain;
  const OtherProcess other(domain.id());
  Participant participant({.domain = domain.id(), .machine = "mill"});
  Writer<Reply> writer(participant);
  StalledReaders stalled(participant);
  stalled.watch(writer.handle(), "reply");
  ASSERT_TRUE(comes([&] { return writer.matched_readers() == 1; }));
  ASSERT_TRUE(writer.write({.request = 1}));
  EXPECT_TRUE(comes([&] { return !find_unacknowledged(participant, writer.handle()); }));

  other.stop();
  auto longest = Clock::duration::zero();
  for (int n = 0; n < 2000; ++n) {
    const auto before = Clock::now();
    ASSERT_TRUE(writer.write({.request = 2, .text = std::string(kMaxText, 'x')})) << n;
    longest = std::max(longest, Clock::now() - before);
  }
  EXPECT_LT(longest, milliseconds(50)) << "a write that waits waits for 100 ms";
  EXPECT_EQ(stalled.look(kSecond_ns), "") << "not yet";
  const std::string who = stalled.look(4 * kSecond_ns);
  EXPECT_NE(who.find("process " + std::to_string(other.id()) + " on host "), std::string::npos)
      << who;
  EXPECT_NE(who.find("(reply)"), std::string::npos);

  other.go_on();
  EXPECT_TRUE(comes([&] { return !find_unacknowledged(participant, writer.handle()); }));
  EXPECT_EQ(stalled.look(9 * kSecond_ns), "");
}

TEST(StalledReaders, TheOneThatIsThereIsNamedWhoeverLeft) {
  const support::PrivateDomain domain;
  constexpr int kCount = 6;
  std::array<std::unique_ptr<OtherProcess>, kCount> others;
  for (auto& other : others) other = std::make_unique<OtherProcess>(domain.id());
  Participant participant({.domain = domain.id(), .machine = "mill"});
  Writer<Reply> writer(participant);
  ASSERT_TRUE(comes([&] { return writer.matched_readers() == kCount; }));
  const OtherProcess& stuck = *others[kCount / 2];
  stuck.stop();
  std::this_thread::sleep_for(milliseconds(20));
  for (auto& other : others) {
    ASSERT_TRUE(writer.write({.request = 2}));
    if (other.get() != &stuck) other->leave();
    ASSERT_TRUE(writer.write({.request = 3}));
    EXPECT_TRUE(comes([&] { return names(participant, writer.handle(), stuck); }))
        << find_unacknowledged(participant, writer.handle()).value_or(Unacknowledged{}).who;
  }
}

}  // namespace
}  // namespace meridian::dds
