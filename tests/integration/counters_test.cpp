// SPDX-License-Identifier: Apache-2.0

/// What the cycle and publisher threads of the real service ask of heap, locks and kernel over a
/// whole run: programs with hold, resume and override over DDS with drives, after a first program
/// as warm-up. Counted from outside by libmeridian_watch.so; budgets in deploy/budgets.toml.

#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "integration/plant.hpp"
#include "service/host/probe/budgets.hpp"
#include "service/host/process/child_process.hpp"
#include "support/heap_watch.hpp"
#include "support/watch_report.hpp"

namespace meridian::test {
namespace {

using probe::load_budget;
using stream::Station;
using stream::StationState;

bool is_complete(const Station& station) { return station.state() == StationState::kComplete; }
bool has_ran(const Station& station) { return station.state() == StationState::kRan; }

/// A plant whose service runs with the counters on, and traced: that must cost nothing either.
class Counters : public testing::Test {
 protected:
  Counters() : watched_(plant_.folder() / "watch") {}

  void SetUp() override {
    if (!watch::is_heap_watched()) {
      GTEST_SKIP() << "the sanitizer owns malloc";
    }
    for (const std::string& pair : watched_.environment()) {
      const auto equals = pair.find('=');
      ::setenv(pair.substr(0, equals).c_str(), pair.substr(equals + 1).c_str(), 1);
    }
    plant_.start_service({"--trace", (plant_.folder() / "traces").string()});
    ::unsetenv("LD_PRELOAD");
    ::unsetenv("MERIDIAN_WATCH");
    plant_.start_drives();
    ASSERT_TRUE(plant_.enable()) << plant_.service().said();
    has_locked_memory_ =
        plant_.service().said().find("memory cannot be locked") == std::string::npos;
  }

  void load(int blocks, double feed_mm_per_min) {
    ASSERT_TRUE(plant_.stream(small_program(blocks, feed_mm_per_min), is_complete))
        << plant_.station().message() << plant_.service().said();
    ASSERT_TRUE(plant_.wait_for(State::kLoaded)) << plant_.service().said();
  }

  void say(Verb verb, double argument = 0) { ASSERT_NO_FATAL_FAILURE(plant_.must(verb, argument)); }

  /// A program from its first block to its end, held and resumed on the way, at changing override.
  void run_program(int blocks) {
    load(blocks, 3000);
    say(Verb::kStart);
    ASSERT_TRUE(plant_.wait_for(State::kRunning));
    say(Verb::kFeedOverride, 0.6);
    std::this_thread::sleep_for(milliseconds(300));
    say(Verb::kHold);
    ASSERT_TRUE(plant_.wait_for(State::kHeld));
    say(Verb::kResume);
    say(Verb::kFeedOverride, 1.0);
    ASSERT_TRUE(plant_.stream_on(has_ran, milliseconds(30000)))
        << plant_.station().message() << plant_.service().said();
    ASSERT_TRUE(plant_.wait_for(State::kReady));
  }

  Plant plant_;
  watch::WatchedProgram watched_;
  bool has_locked_memory_ = false;
};

TEST_F(Counters, AWholeRunCostsCycleAndPublisherNoHeapCallNoPageFaultAndTheCycleNoLock) {
  ASSERT_NO_FATAL_FAILURE(run_program(10));
  const watch::Report begin = watched_.report("begin");
  const dds::Status before = plant_.status();
  ASSERT_NO_FATAL_FAILURE(run_program(40));
  const dds::Status after = plant_.status();
  const watch::Report change = watch::difference(begin, watched_.report("end"));
  std::printf("%llu cycles, %llu periods lost, memory %s\n%s",
              static_cast<unsigned long long>(after.cycles_run - before.cycles_run),
              static_cast<unsigned long long>(after.periods_lost - before.periods_lost),
              has_locked_memory_ ? "locked" : "not locked: best effort",
              watch::to_text(change).c_str());

  const watch::ThreadCounts* const cycle = watch::find_thread(change, "cycle");
  const watch::ThreadCounts* const publisher = watch::find_thread(change, "publisher");
  ASSERT_TRUE(cycle != nullptr && publisher != nullptr) << watch::to_text(change);
  for (const watch::ThreadCounts* const thread : {cycle, publisher}) {
    EXPECT_LE(thread->allocations + thread->frees, load_budget("cycle_heap_calls").allowed())
        << thread->name << "\n"
        << watch::callers_text(*thread);
    if (has_locked_memory_) {
      EXPECT_LE(thread->minor_faults + thread->major_faults,
                load_budget("cycle_page_faults").allowed())
          << thread->name;
    }
  }
  EXPECT_LE(cycle->locks, load_budget("cycle_locks").allowed());
  EXPECT_GT(publisher->locks, 1000U) << "Cyclone's own: are locks still counted?";
  EXPECT_LE(static_cast<double>(publisher->contended_locks),
            load_budget("publisher_lock_waits")
                .allowed(static_cast<double>(after.cycles_run - before.cycles_run)));
  // One sleep a cycle and no other wait. The status is up to one period of its rate older than the
  // counters.
  constexpr std::uint64_t kStatusAge_cycles = 300;
  EXPECT_LE(cycle->voluntary_switches, after.cycles_run - before.cycles_run + kStatusAge_cycles);
  EXPECT_GT(cycle->voluntary_switches, 1000U) << "the cycle hardly ran";
}

/// The system calls of one thread, by strace.
struct Traced {
  std::size_t count = 0;
  std::map<std::string, std::size_t> calls;
  std::size_t futex_waits = 0;  ///< calls of futex that may wait
  [[nodiscard]] std::string text() const {
    std::ostringstream out;
    for (const auto& [call, times] : calls) out << call << " " << times << ", ";
    return out.str();
  }
  /// Takes out what is wanted; what is left is not.
  void take_out(const std::vector<std::string>& wanted) {
    calls.erase("restart_syscall");  // the wait that strace came into
    for (const std::string& call : wanted) calls.erase(call);
  }
};

/// strace on one thread, as long as it lives.
class Strace {
 public:
  Strace(int thread, std::filesystem::path file)
      : file_(std::move(file)),
        strace_({"/bin/sh", "-c",
                 "exec strace -p " + std::to_string(thread) + " -o " + file_.string() +
                     " 2> /dev/null"}) {}

  /// Whether it may, and saw a first call.
  [[nodiscard]] bool has_begun() {
    std::error_code none;
    return eventually([&] {
             const auto size = std::filesystem::file_size(file_, none);
             return (!none && size > 0) || strace_.wait_for_exit(milliseconds(0));
           }) &&
           !strace_.wait_for_exit(milliseconds(0));
  }
  /// Ends it: what it saw.
  [[nodiscard]] Traced end() {
    strace_.send_signal(SIGINT);
    EXPECT_TRUE(strace_.wait_for_exit(milliseconds(5000)));
    Traced traced;
    std::ifstream lines(file_);
    for (std::string line; std::getline(lines, line);) {
      const auto bracket = line.find('(');
      if (bracket == std::string::npos || line.rfind("---", 0) == 0 ||
          line.rfind("strace", 0) == 0) {
        continue;
      }
      const std::string call = line.substr(0, bracket);
      ++traced.calls[call];
      ++traced.count;
      if (call == "futex" && line.find("FUTEX_WAKE") == std::string::npos) ++traced.futex_waits;
    }
    return traced;
  }

 private:
  std::filesystem::path file_;
  process::ChildProcess strace_;
};

class SystemCalls : public Counters {
 protected:
  /// Those of one thread while a program is cut, held and aborted; none: it cannot be traced.
  void trace_program(const char* name, Traced& traced) {
    ASSERT_NO_FATAL_FAILURE(load(40, 600));
    ASSERT_NO_FATAL_FAILURE(say(Verb::kStart));
    ASSERT_TRUE(plant_.wait_for(State::kRunning)) << plant_.standing();
    const watch::Report report = watched_.report(name);
    const watch::ThreadCounts* const thread = watch::find_thread(report, name);
    ASSERT_NE(thread, nullptr) << watch::to_text(report);
    Strace strace(thread->thread_id, plant_.folder() / (std::string(name) + ".strace"));
    if (!strace.has_begun()) return;
    std::this_thread::sleep_for(milliseconds(200));
    ASSERT_NO_FATAL_FAILURE(say(Verb::kHold));
    ASSERT_TRUE(plant_.wait_for(State::kHeld)) << plant_.standing();
    ASSERT_NO_FATAL_FAILURE(say(Verb::kAbort));
    // The next program is let in.
    ASSERT_TRUE(plant_.runs_until([](const dds::Status& now) {
      return now.state == State::kReady && now.session == 0;
    })) << plant_.standing();
    traced = strace.end();
    std::printf("%zu system calls of the %s thread: %s\n", traced.count, name,
                traced.text().c_str());
    EXPECT_GT(traced.count, 200U) << "it was hardly traced";
  }
};

TEST_F(SystemCalls, OfCycleAndPublisherAreNothingButSleepWakeAndSending) {
  if (std::system("strace -V > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "no strace on this host, as on one without the rights to trace";
  }
  Traced publisher, cycle;
  ASSERT_NO_FATAL_FAILURE(trace_program("publisher", publisher));
  if (publisher.count > 0) {
    ASSERT_NO_FATAL_FAILURE(trace_program("cycle", cycle));
  }
  if (cycle.count == 0 || publisher.count == 0) {
    GTEST_SKIP() << "this host does not let strace attach (no rights)";
  }
  EXPECT_EQ(cycle.futex_waits, 0U) << "it waits for a lock";
  EXPECT_LE(cycle.calls["futex"], cycle.calls["clock_nanosleep"] + 1) << "one wake a cycle";
  cycle.take_out({"clock_nanosleep", "futex"});
  EXPECT_TRUE(cycle.calls.empty()) << cycle.text();
  publisher.take_out({"futex", "sendmsg"});
  EXPECT_TRUE(publisher.calls.empty()) << publisher.text();
}

}  // namespace
}  // namespace meridian::test
