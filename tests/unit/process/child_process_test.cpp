// SPDX-License-Identifier: Apache-2.0
#include "service/host/process/child_process.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>

namespace meridian::process {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kWithin{5000};

TEST(ChildProcess, TalksInLines) {
  ChildProcess cat({"/bin/cat"});
  cat.write_line("one");
  cat.write_line("two");
  EXPECT_EQ(cat.read_line(kWithin), "one");
  EXPECT_EQ(cat.read_line(kWithin), "two");
  EXPECT_EQ(cat.read_line(milliseconds(1)), std::nullopt);
  cat.close_input();
  EXPECT_EQ(cat.wait_for_exit(kWithin), 0);
}

TEST(ChildProcess, ReportsExitCodeSignalAndThatItStillRuns) {
  ChildProcess three({"/bin/sh", "-c", "exit 3"});
  EXPECT_EQ(three.wait_for_exit(kWithin), 3);
  ChildProcess sleeper({"/bin/sleep", "60"});
  EXPECT_EQ(sleeper.wait_for_exit(milliseconds(1)), std::nullopt);
  sleeper.send_signal(SIGTERM);
  EXPECT_EQ(sleeper.wait_for_exit(kWithin), 128 + SIGTERM);
  ChildProcess nothing({"/no/such/program"});
  EXPECT_EQ(nothing.wait_for_exit(kWithin), 127);
}

TEST(ChildProcess, HandsOverItsEnvironment) {
  ChildProcess shell({"/bin/sh", "-c", "echo $MERIDIAN_SAMPLE"}, {{"MERIDIAN_SAMPLE=value"}, ""});
  EXPECT_EQ(shell.read_line(kWithin), "value");
}

}  // namespace
}  // namespace meridian::process
