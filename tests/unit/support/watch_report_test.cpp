// SPDX-License-Identifier: Apache-2.0
#include "support/watch_report.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "service/host/process/child_process.hpp"
#include "support/heap_watch.hpp"

namespace meridian::watch {
namespace {

constexpr std::chrono::seconds kWithin{5};

TEST(WatchReport, CountsAProgramThatWasNotBuiltForIt) {
  if (!is_heap_watched()) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  const auto folder =
      std::filesystem::temp_directory_path() / ("meridian_watch_" + std::to_string(getpid()));
  const WatchedProgram program(folder);
  process::ChildProcess child({MERIDIAN_WATCHED_PROGRAM}, {program.environment(), ""});
  ASSERT_EQ(child.read_line(kWithin), "ready");
  child.write_line("go");  // warm-up: the first allocation of a thread sets up its own heap cache
  ASSERT_EQ(child.read_line(kWithin), "done");
  const Report begin = program.report("begin");
  child.write_line("go");
  ASSERT_EQ(child.read_line(kWithin), "done");
  const Report change = difference(begin, program.report("end"));
  std::filesystem::remove_all(folder);

  const ThreadCounts* const busy = find_thread(change, "busy");
  const ThreadCounts* const idle = find_thread(change, "idle");
  ASSERT_NE(busy, nullptr) << to_text(change);
  ASSERT_NE(idle, nullptr) << to_text(change);
  EXPECT_EQ(busy->allocations, 5U);
  EXPECT_EQ(busy->frees, 5U);
  ASSERT_EQ(busy->heap_callers.size(), 4U) << "the first of its ten calls";
  EXPECT_EQ(busy->heap_callers[0].rfind("malloc < operator new(", 0), 0U) << busy->heap_callers[0];
  EXPECT_NE(busy->heap_callers[0].find("watched_program+0x"), std::string::npos)
      << callers_text(*busy);
  EXPECT_EQ(busy->heap_callers[1].rfind("free < ", 0), 0U) << busy->heap_callers[1];
  EXPECT_TRUE(idle->heap_callers.empty());
  EXPECT_EQ(busy->locks, 3U);
  EXPECT_EQ(busy->contended_locks, 0U);
  EXPECT_GE(busy->minor_faults, 1U);
  EXPECT_LE(busy->voluntary_switches, 2U);
  EXPECT_EQ(idle->allocations + idle->frees + idle->locks + idle->minor_faults, 0U)
      << to_text(change);
  EXPECT_LE(idle->voluntary_switches, 1U);  // it may fall asleep after the first report
}

TEST(WatchReport, SaysSoWhenNobodyAnswers) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("meridian_nobody_" + std::to_string(getpid()));
  const WatchedProgram program(folder);
  EXPECT_THROW((void)program.report("begin", std::chrono::milliseconds(50)), std::runtime_error);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace meridian::watch
