// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/report_wire.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "support/heap_watch.hpp"

namespace meridian::drives {
namespace {

/// What arrives in each of `periods` periods, in each of which one report sets out.
[[nodiscard]] std::vector<std::vector<std::uint64_t>> arrivals(ReportWire& wire, int periods) {
  std::vector<std::vector<std::uint64_t>> all;
  for (int n = 1; n <= periods; ++n) {
    wire.work(1);
    dds::DriveFeedback report;
    report.sample = static_cast<std::uint64_t>(n);
    wire.put(report);
    all.emplace_back();
    while (wire.arrives(report)) all.back().push_back(report.sample);
  }
  return all;
}

using Arrivals = std::vector<std::vector<std::uint64_t>>;

TEST(ReportWire, ThatIsWellBringsEachReportAtOnce) {
  ReportWire wire;
  EXPECT_EQ(arrivals(wire, 3), (Arrivals{{1}, {2}, {3}}));
}

TEST(ReportWire, ThatIsWellMakesNoHeapCall) {
  if (!watch::is_heap_watched()) GTEST_SKIP() << "sanitizers watch the heap themselves";
  ReportWire wire;
  dds::DriveFeedback report;
  int arrived = 0;
  const watch::HeapWatch heap;
  for (int n = 0; n < 100; ++n) {
    wire.work(1);
    wire.put(report);
    while (wire.arrives(report)) ++arrived;
  }
  const watch::HeapCalls calls = heap.calls();
  EXPECT_EQ(calls, watch::HeapCalls{}) << watch::HeapWatch::callers(calls);
  EXPECT_EQ(arrived, 100);
}

TEST(ReportWire, BringsWhatIsUnderWayAheadOfWhatSetsOutBehindIt) {
  ReportWire wire;
  wire.delay(2);
  EXPECT_EQ(arrivals(wire, 2), (Arrivals{{}, {}}));
  wire.delay(0);
  EXPECT_EQ(arrivals(wire, 3), (Arrivals{{1}, {2, 1, 2}, {3}})) << "numbered anew";
}

TEST(ReportWire, ThatIsLateBringsAllOfThemInTheirOrder) {
  ReportWire wire;
  wire.delay(2);
  EXPECT_EQ(arrivals(wire, 4), (Arrivals{{}, {}, {1}, {2}}));
}

TEST(ReportWire, ThatDoublesBringsEachTwice) {
  ReportWire wire;
  wire.send_twice();
  EXPECT_EQ(arrivals(wire, 2), (Arrivals{{1, 1}, {2, 2}}));
}

TEST(ReportWire, ThatSwapsBringsTheLaterOfTwoFirst) {
  ReportWire wire;
  wire.swap_neighbours();
  EXPECT_EQ(arrivals(wire, 4), (Arrivals{{}, {2, 1}, {}, {4, 3}}));
}

}  // namespace
}  // namespace meridian::drives
