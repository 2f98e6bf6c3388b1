// SPDX-License-Identifier: Apache-2.0
#include "support/watch_report.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "support/heap_watch.hpp"

namespace meridian::watch {
namespace {

/// The watched program with pipes to its standard input and output.
class Child {
 public:
  explicit Child(const WatchedProgram& program) {
    std::array<int, 2> in{};
    std::array<int, 2> out{};
    if (pipe(in.data()) != 0 || pipe(out.data()) != 0) {
      throw std::runtime_error("pipe");
    }
    id_ = fork();
    if (id_ == 0) {
      dup2(in[0], STDIN_FILENO);
      dup2(out[1], STDOUT_FILENO);
      for (const int descriptor : {in[0], in[1], out[0], out[1]}) {
        close(descriptor);
      }
      for (const std::string& pair : program.environment()) {
        const auto equals = pair.find('=');
        setenv(pair.substr(0, equals).c_str(), pair.substr(equals + 1).c_str(), 1);
      }
      execl(MERIDIAN_WATCHED_PROGRAM, MERIDIAN_WATCHED_PROGRAM, static_cast<char*>(nullptr));
      _exit(127);
    }
    close(in[0]);
    close(out[1]);
    to_ = fdopen(in[1], "w");
    from_ = fdopen(out[0], "r");
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    std::fclose(to_);
    waitpid(id_, nullptr, 0);
    std::fclose(from_);
  }

  std::string read_line() {
    std::array<char, 64> line{};
    return std::fgets(line.data(), line.size(), from_) != nullptr ? line.data() : "";
  }
  void write_line() {
    std::fputs("go\n", to_);
    std::fflush(to_);
  }

 private:
  pid_t id_ = 0;
  std::FILE* to_ = nullptr;
  std::FILE* from_ = nullptr;
};

TEST(WatchReport, CountsAProgramThatWasNotBuiltForIt) {
  if (!is_heap_watched()) {
    GTEST_SKIP() << "the sanitizer owns malloc";
  }
  const auto folder =
      std::filesystem::temp_directory_path() / ("meridian_watch_" + std::to_string(getpid()));
  const WatchedProgram program(folder);
  Child child(program);
  ASSERT_EQ(child.read_line(), "ready\n");
  child.write_line();  // warm-up: the first allocation of a thread sets up its own heap cache
  ASSERT_EQ(child.read_line(), "done\n");
  const Report begin = program.report("begin");
  child.write_line();
  ASSERT_EQ(child.read_line(), "done\n");
  const Report change = difference(begin, program.report("end"));
  std::filesystem::remove_all(folder);

  const ThreadCounts* const busy = find_thread(change, "busy");
  const ThreadCounts* const idle = find_thread(change, "idle");
  ASSERT_NE(busy, nullptr) << to_text(change);
  ASSERT_NE(idle, nullptr) << to_text(change);
  EXPECT_EQ(busy->allocations, 5U);
  EXPECT_EQ(busy->frees, 5U);
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
