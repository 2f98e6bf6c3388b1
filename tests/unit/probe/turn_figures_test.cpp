// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/turn_figures.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "service/host/process/programs.hpp"

namespace meridian::probe {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

struct Row {
  std::uint64_t cycle;
  std::int64_t lateness_ns, computation_before_ns;
  const char* state = "off";
};

/// Times as they are read from a recording of these rows; cycle n is due at n periods.
std::vector<CycleTimes> times_of(const std::vector<Row>& rows) {
  const process::ScratchFolder folder;
  const auto file = folder.path() / "recording.csv";
  {
    std::ofstream out(file);
    out << "cycle,due_ns,state,lateness_ns,computation_ns\n";
    for (const Row& row : rows) {
      out << row.cycle << "," << static_cast<std::int64_t>(row.cycle) * kPeriod_ns << ","
          << row.state << "," << row.lateness_ns << "," << row.computation_before_ns << "\n";
    }
  }
  return read_times(file, kPeriod_ns);
}

/// A computation of 2.5 ms in cycle 2 costs the periods 3 and 4; the row of cycle 5 reports it.
const std::vector<Row> kLongComputation{{0, 10'000, 0},
                                        {1, 10'000, 2000},
                                        {2, 10'000, 2000},
                                        {5, 20'000, 2'500'000},
                                        {6, 10'000, 2000}};

TEST(TurnFigures, AComputationThatCostsPeriodsIsTimed) {
  const auto times = times_of(kLongComputation);
  ASSERT_EQ(times.size(), 5U);
  EXPECT_EQ(times[2].computation_ns, 2'500'000);
  EXPECT_EQ(times[3].lost, 2U);
  EXPECT_EQ(times[3].lateness_ns, 2'020'000);
  EXPECT_EQ(times[4].computation_ns, -1) << "it is not reported yet";
}

TEST(TurnFigures, TheTransportOfItsSetpointIsMeasuredToo) {
  const auto times = times_of(kLongComputation);
  std::vector<DriveSide::Arrival> arrivals;
  for (const CycleTimes& time : times) {
    arrivals.push_back({time.cycle, time.due_ns, time.due_ns + 4'000'000});
  }
  TurnFigures figures;
  add_turn({0, 7 * kPeriod_ns}, kPeriod_ns, times, arrivals, figures);
  EXPECT_EQ(figures.one_way_ns[0],
            (std::vector<std::int64_t>{3'988'000, 3'988'000, 1'490'000, 3'978'000}));
  EXPECT_EQ(figures.setpoints.missing, 0U);
  EXPECT_EQ(figures.setpoints.of, 4U);
  EXPECT_EQ(figures.untimed, 1U) << "the last row has none behind it";
}

TEST(TurnFigures, PeriodsThatNobodyExecutedAreLostAndWereLate) {
  TurnFigures figures;
  add_turn({0, 10 * kPeriod_ns}, kPeriod_ns, times_of(kLongComputation), {}, figures);
  EXPECT_EQ(figures.periods.of, 10U);
  EXPECT_EQ(figures.periods.missing, 5U) << "3 and 4, and 7 to 9 at the end of the turn";
  EXPECT_EQ(figures.lateness_ns[0],
            (std::vector<std::int64_t>{10'000, 10'000, 10'000, 2'020'000, 10'000}));
  EXPECT_EQ(figures.setpoints.missing, 4U) << "no drive saw any";
}

TEST(TurnFigures, ATurnWithoutAnyRowIsAllLost) {
  TurnFigures figures;
  add_turn({100 * kPeriod_ns, 110 * kPeriod_ns}, kPeriod_ns, times_of(kLongComputation), {},
           figures);
  EXPECT_EQ(figures.periods.missing, 10U);
  EXPECT_TRUE(figures.lateness_ns.at(0).empty());
}

TEST(TurnFigures, OfACutAreFromItsFirstMotionToItsLast) {
  std::vector<Row> rows;
  for (std::uint64_t cycle = 0; cycle < 100; ++cycle) {
    rows.push_back({cycle, 1000, 2000, cycle < 20 || cycle >= 75 ? "ready" : "running"});
  }
  const auto times = times_of(rows);
  const std::vector<Window> turns = moving_turns(times, kPeriod_ns, 20 * kPeriod_ns);
  ASSERT_EQ(turns.size(), 2U);
  EXPECT_EQ(turns[0].begin_ns, 20 * kPeriod_ns);
  EXPECT_EQ(turns[1].begin_ns, 40 * kPeriod_ns);
  EXPECT_EQ(turns[1].end_ns, 75 * kPeriod_ns) << "what is left over belongs to the last";
  TurnFigures figures;
  for (const Window& turn : turns) add_turn(turn, kPeriod_ns, times, {}, figures);
  EXPECT_EQ(figures.computation_ns.size(), 55U);
  EXPECT_EQ(figures.moving, 55U);
  EXPECT_EQ(figures.periods.of, 55U);
  EXPECT_EQ(figures.periods.missing, 0U);
  EXPECT_TRUE(moving_turns(times_of({{0, 0, 0}}), kPeriod_ns, kPeriod_ns).empty());
}

}  // namespace
}  // namespace meridian::probe
