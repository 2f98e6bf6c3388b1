// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/motion/time_check.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "support/sample_recording.hpp"

namespace meridian::record {
namespace {

using test::cut_to;

constexpr double kPeriod_s = 1e-3, kTolerance_mm = 0.1;

/// A quarter of a circle of 3 mm in `asked_s`: six parts, each within ten tolerances of its ends.
CheckedPath quarter_in(double asked_s) {
  CheckedPath path(0, 0);
  path.add(cut_to(1, {3, 0, 0}, 0, 10), 0);
  ClBlock arc = cut_to(2, {0, 3, 0}, 0, 1 / asked_s);
  arc.feed_meaning = FeedMeaning::kInverseTime;
  arc.is_arc = true;
  arc.centre_mm = {0, 0, 0};
  arc.normal = {0, 0, 1};
  arc.sweep_rad = std::numbers::pi / 2;
  path.add(arc, 0);
  return path;
}

/// What is found where the quarter is cut evenly in `taken_s`.
CheckReport check(double asked_s, double taken_s) {
  const CheckedPath path = quarter_in(asked_s);
  const PathElement& last = path.elements().back();
  const double whole = last.path_begin + last.path_length;
  TimeCheck check(path, kTolerance_mm, kPeriod_s, CheckOptions{});
  const auto cycles = static_cast<std::uint64_t>(taken_s / kPeriod_s);
  for (std::uint64_t cycle = 0; cycle <= cycles; ++cycle) {
    const double path_begin = whole * static_cast<double>(cycle) / static_cast<double>(cycles);
    check.add(path_begin, path_begin, cycle);
  }
  CheckReport report;
  check.finish(report);
  return report;
}

TEST(TimeCheck, TimesAnArcAsTheOneBlockThatItIs) {
  EXPECT_TRUE(check(0.5, 0.5).findings.empty());
  const CheckReport report = check(0.5, 0.3);
  ASSERT_EQ(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].kind, Finding::Kind::kBlockTime);
  EXPECT_EQ(report.findings[0].count, 1U);
  EXPECT_EQ(report.findings[0].line, 2U);
}

}  // namespace
}  // namespace meridian::record
