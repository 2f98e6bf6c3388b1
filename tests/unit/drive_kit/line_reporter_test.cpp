// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/line_reporter.hpp"

#include <gtest/gtest.h>

#include <future>
#include <optional>
#include <string>
#include <vector>

namespace meridian::drive {
namespace {

TEST(LineReporter, PrintsEveryLineInItsOrderUntilItsEnd) {
  std::vector<std::string> printed;
  {
    LineReporter reporter([&](const std::string& line) { printed.push_back(line); });
    for (int i = 0; i < 20; ++i) reporter.write_line("line " + std::to_string(i));
    reporter.write_line(std::string(1000, 'x'));
  }
  ASSERT_EQ(printed.size(), 21U);
  EXPECT_EQ(printed.front(), "line 0");
  EXPECT_EQ(printed[19], "line 19");
  EXPECT_EQ(printed.back(), std::string(LineReporter::kMaxBytes, 'x'));
}

TEST(LineReporter, LetsNobodyWaitForAPrinterThatIsHeldAndSaysWhatWasLost) {
  std::vector<std::string> printed;
  std::promise<void> is_printing, may_go_on;
  std::optional<LineReporter> reporter;
  reporter.emplace([&](const std::string& line) {
    printed.push_back(line);
    if (printed.size() > 1) return;
    is_printing.set_value();
    may_go_on.get_future().wait();
  });
  reporter->write_line("held");
  is_printing.get_future().wait();
  for (std::size_t i = 0; i < LineReporter::kMaxLines + 44; ++i) reporter->write_line("waits");
  may_go_on.set_value();
  reporter.reset();
  ASSERT_EQ(printed.size(), LineReporter::kMaxLines + 2);
  EXPECT_EQ(printed.back(), "44 lines lost: nobody took them in time");
}

}  // namespace
}  // namespace meridian::drive
