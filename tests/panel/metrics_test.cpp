// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/metrics.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "support/scratch.hpp"

namespace meridian::panel {
namespace {

[[nodiscard]] dds::MachineInfo machine_info() {
  dds::MachineInfo machine;
  machine.name = "la\"i\\";
  machine.service_version = "0.1.0";
  return machine;
}

[[nodiscard]] dds::Latency latency() {
  dds::Latency out;
  out.histograms.push_back({"wake-up lateness", {}});
  for (const int ns : {500, 1500, 3'000'000}) out.histograms[0].histogram.record(ns);
  return out;
}

[[nodiscard]] bool has(const std::string& text, const std::string& line) {
  return text.find(line + "\n") != std::string::npos;
}

TEST(Metrics, SayThatAServiceIsSilent) {
  const std::string text = metrics_text(machine_info(), std::nullopt, std::nullopt);
  EXPECT_TRUE(has(text, R"(meridian_up{machine="la\"i\\"} 0)")) << text;
  EXPECT_EQ(text.find("meridian_cycles_total"), std::string::npos);
}

TEST(Metrics, AreInBaseUnits) {
  dds::Status status;
  status.state = State::kRunning;
  status.feed_achieved_mm_per_min = 6000;
  status.cycles_run = 12;
  const std::string text = metrics_text(machine_info(), status, std::nullopt);
  const std::string machine = R"({machine="la\"i\\")";
  EXPECT_NE(text.find("meridian_feed_achieved_metres_per_second" + machine + "} 0.1"),
            std::string::npos)
      << text;
  EXPECT_TRUE(has(text, "meridian_cycles_total" + machine + "} 12"));
  EXPECT_TRUE(has(text, "meridian_state" + machine + R"(,state="running"} 1)"));
  EXPECT_TRUE(has(text, "meridian_state" + machine + R"(,state="off"} 0)"));
}

TEST(Metrics, BucketsOfAHistogramAddUp) {
  const std::string text = metrics_text(machine_info(), dds::Status{}, latency());
  const std::string of = R"({machine="la\"i\\",stage="wake-up lateness")";
  EXPECT_TRUE(has(text, "meridian_latency_seconds_bucket" + of + R"(,le="1e-06"} 1)")) << text;
  EXPECT_TRUE(has(text, "meridian_latency_seconds_bucket" + of + R"(,le="2e-06"} 2)"));
  EXPECT_TRUE(has(text, "meridian_latency_seconds_bucket" + of + R"(,le="0.005"} 3)"));
  EXPECT_TRUE(has(text, "meridian_latency_seconds_bucket" + of + R"(,le="+Inf"} 3)"));
  EXPECT_TRUE(has(text, "meridian_latency_seconds_count" + of + "} 3"));
}

/// Names of series that `text` asks for.
[[nodiscard]] std::set<std::string> series_in(const std::string& text) {
  std::set<std::string> names;
  const std::regex name("\\bmeridian_[a-z_]+");
  for (std::sregex_iterator at(text.begin(), text.end(), name), end; at != end; ++at) {
    names.insert(at->str());
  }
  return names;
}

[[nodiscard]] std::string file_text(const std::string& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

TEST(Metrics, AreAllThatDashboardAndRulesAskFor) {
  const std::string folder = MERIDIAN_SOURCE_DIR "/deploy/monitoring/";
  const auto dashboard = nlohmann::json::parse(file_text(folder + "grafana-dashboard.json"));
  std::string asked = file_text(folder + "meridian-rules.yml");
  for (const auto& panel : dashboard["panels"]) {
    for (const auto& target : panel["targets"]) asked += "\n" + target["expr"].get<std::string>();
  }
  const std::string text = metrics_text(machine_info(), dds::Status{}, latency());
  const auto names = series_in(asked);
  EXPECT_GT(names.size(), 15U);
  for (const std::string& name : names) {
    EXPECT_NE(text.find("\n" + name + "{"), std::string::npos) << name;
  }
}

TEST(Metrics, SamplesOfThePackagePassPromtool) {
  if (std::system("command -v promtool >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "promtool is not here (Debian's prometheus)";
  }
  const std::string file = MERIDIAN_SOURCE_DIR "/deploy/monitoring/prometheus.yml";
  EXPECT_EQ(std::system(("promtool check config " + file).c_str()), 0);
}

TEST(Metrics, PassPromtool) {
  if (std::system("command -v promtool >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "promtool is not here (Debian's prometheus)";
  }
  const test::Scratch file(".txt");
  std::ofstream(file.path()) << metrics_text(machine_info(), dds::Status{}, latency());
  EXPECT_EQ(std::system(("promtool check metrics < " + file.path()).c_str()), 0);
}

}  // namespace
}  // namespace meridian::panel
