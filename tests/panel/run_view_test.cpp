// SPDX-License-Identifier: Apache-2.0
#include "service/panel/program/run_view.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "service/machine/file/machine_file.hpp"

namespace meridian::panel {
namespace {

using nlohmann::json;

[[nodiscard]] const MachineModel& seen_machine() {
  static const MachineModel kModel =
      config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml");
  return kModel;
}

/// What lies in a page that was written.
[[nodiscard]] json report_in(const std::string& page) {
  const std::string begin = R"(id="report">)", end = "</script>";
  const std::size_t from = page.find(begin) + begin.size();
  return json::parse(page.substr(from, page.find(end, from) - from));
}

/// X runs along at `step` mm a cycle.
void run(RunView& view, int cycles, double step, int tool_changed_at = -1) {
  for (int i = 0; i < cycles; ++i) {
    Setpoint setpoint;
    setpoint.cycle = static_cast<std::uint64_t>(i) + 1;
    setpoint.position[0] = step * i;
    setpoint.line = 7;
    setpoint.flags = kSetpointEnabled;
    view.add(setpoint,
             {.programmed_mm_per_s = 60,
              .limit = 1,
              .tool_length_mm = tool_changed_at >= 0 && i >= tool_changed_at ? 85.0 : 110.0});
  }
}

TEST(RunView, TheFeedIsTheTipsPathByItsTime) {
  RunView view(seen_machine());
  run(view, 100, 0.05);
  const json columns = report_in(view.html({}, {}))["columns"];
  ASSERT_EQ(columns["feed"].size(), 100U);
  EXPECT_NEAR(columns["feed"][50].get<double>(), 0.05 * 1000 * 60, 0.01);
  EXPECT_NEAR(columns["programmed"][50].get<double>(), 3600, 0.01);
  EXPECT_NEAR(columns["time"][50].get<double>(), 0.05, 1e-9);
  EXPECT_NEAR(columns["tip"][3 * 50].get<double>(), 2.5, 1e-6);
}

TEST(RunView, WhatHeldCyclesThatBrakeIsKnownBehindThem) {
  RunView view(seen_machine());
  run(view, 10, 0.05);
  view.decide(4);
  run(view, 5, 0.05);
  const json cause = report_in(view.html({}, {}))["columns"]["cause"];
  ASSERT_EQ(cause.size(), 15U);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(cause[i], 4);
  for (std::size_t i = 10; i < 15; ++i) EXPECT_EQ(cause[i], RunView::kUndecided);
}

TEST(RunView, AnotherToolIsNoPath) {
  RunView view(seen_machine());
  run(view, 100, 0.05, 50);
  const json columns = report_in(view.html({}, {}))["columns"];
  for (const double feed : columns["feed"]) EXPECT_LE(feed, 0.05 * 1000 * 60 + 0.01);
  EXPECT_NEAR(columns["tip"][3 * 50 + 2].get<double>(),
              columns["tip"][3 * 49 + 2].get<double>() + 25, 1e-6);
}

TEST(RunView, ALongRunKeepsItsFeedAndGrowsNoFurther) {
  RunView view(seen_machine());
  run(view, 100'000, 0.001);
  EXPECT_LT(view.sample_count(), RunView::kMaxSamples);
  EXPECT_GT(view.sample_count(), RunView::kMaxSamples / 4);
  const json columns = report_in(view.html({}, {}))["columns"];
  EXPECT_NEAR(columns["feed"][1000].get<double>(), 60, 0.05);
  EXPECT_NEAR(columns["time"].back().get<double>(), 99.99, 0.05);
}

TEST(RunView, WordsOfAProgramEndNoScript) {
  RunView view(seen_machine());
  run(view, 3, 0.1);
  RunView::Words words;
  words.title = "</script><script>alert(1)</script>";
  const std::string page = view.html({}, words);
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(report_in(page)["title"], words.title);
}

}  // namespace
}  // namespace meridian::panel
