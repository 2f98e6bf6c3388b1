// SPDX-License-Identifier: Apache-2.0
#include "service/text/line_output.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>

namespace meridian::text {
namespace {

using Result = LineOutput::Result;

/// All that is in a pipe or socket now.
std::string drain(int file) {
  (void)::fcntl(file, F_SETFL, O_NONBLOCK);
  std::string text;
  std::array<char, 4096> bytes;
  for (ssize_t count = 0; (count = ::read(file, bytes.data(), bytes.size())) > 0;) {
    text.append(bytes.data(), static_cast<std::size_t>(count));
  }
  return text;
}

void expect_never_waits(int reader, int writer) {
  LineOutput output(writer);
  const std::string line(100, 'x');
  int written = 0;
  while (output.try_write(line + "\n") == Result::kWritten) ++written;
  EXPECT_GT(written, 100);
  EXPECT_EQ(output.try_write(line + "\n"), Result::kNoRoom);
  EXPECT_EQ(::fcntl(writer, F_GETFL) & O_NONBLOCK, 0) << "others have it open too";
  std::string text = drain(reader);
  ASSERT_EQ(output.try_write("behind\n"), Result::kWritten);
  text += drain(reader);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), written + 1) << "whole lines";
  EXPECT_TRUE(text.ends_with(line + "\nbehind\n"));
}

TEST(LineOutput, NeverWaitsForWhoReadsAPipe) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  expect_never_waits(ends[0], ends[1]);
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(LineOutput, NeverWaitsForWhoReadsASocket) {
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
  expect_never_waits(ends[0], ends[1]);
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(LineOutput, SaysWhereNobodyWillEverRead) {
  const auto before = ::signal(SIGPIPE, SIG_IGN);
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ::close(ends[0]);
  LineOutput output(ends[1]);
  EXPECT_EQ(output.try_write("line\n"), Result::kFailed);
  ::close(ends[1]);
  (void)::signal(SIGPIPE, before);
}

}  // namespace
}  // namespace meridian::text
