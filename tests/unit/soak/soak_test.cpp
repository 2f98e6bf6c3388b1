// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "service/drives/simulated/injection.hpp"
#include "service/host/process/programs.hpp"
#include "service/host/soak/chaos.hpp"
#include "service/host/soak/plant.hpp"
#include "service/host/soak/report/soak_report.hpp"
#include "service/host/soak/segments.hpp"
#include "service/host/soak/watch/timeline.hpp"
#include "support/machines.hpp"

namespace meridian::soak {
namespace {

TEST(Chaos, IsTheSameForTheSameSeedAndHoldsEveryMishap) {
  Chaos one(7, 10, 5), same(7, 10, 5), other(8, 10, 5);
  std::set<Mishap> seen;
  double before_s = 0;
  bool differs = false;
  for (int i = 0; i < 400; ++i) {
    const Planned a = one.next(), b = same.next(), c = other.next();
    EXPECT_EQ(a.mishap, b.mishap);
    EXPECT_EQ(a.at_s, b.at_s);
    EXPECT_EQ(a.value, b.value);
    differs = differs || a.at_s != c.at_s;
    EXPECT_GE(a.at_s - before_s, 5);
    EXPECT_LE(a.at_s - before_s, 15);
    before_s = a.at_s;
    const Planned drive = one.next_of_drives();
    EXPECT_LT(drive.drive, 5);
    EXPECT_GE(drive.at_s, 10);
    seen.insert(a.mishap);
    seen.insert(drive.mishap);
  }
  EXPECT_TRUE(differs);
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(kMishapCount));
}

TEST(Chaos, AsksOfTheDrivesWhatTheyUnderstand) {
  const MachineModel model = test::lai_machine();
  Chaos chaos(7, 10, model.joint_count);
  std::set<Mishap> seen;
  for (int i = 0; i < 40; ++i) {
    const Planned mishap = chaos.next_of_drives();
    const auto text = injection_text(mishap, drive_spec(model, mishap.drive).name);
    const auto understood = drives::parse_injection(text, model);
    ASSERT_TRUE(understood) << understood.error();
    EXPECT_NEAR(understood->after_s, mishap.at_s, 1e-6);
    seen.insert(mishap.mishap);
  }
  EXPECT_EQ(seen.size(), 4U);
}

TEST(AskedOverrides, CountFromTheOneInForceOn) {
  AskedOverrides asked;
  EXPECT_EQ(asked.max_since(0), 1);
  asked.announce(1.5, 100);
  asked.announce(0.5, 200);
  asked.announce(1.2, 300);
  EXPECT_EQ(asked.max_since(50), 1.5);
  EXPECT_EQ(asked.max_since(150), 1.5);
  EXPECT_EQ(asked.max_since(200), 1.2);
  EXPECT_EQ(asked.max_since(400), 1.2);
  asked.forget_before(250);
  EXPECT_EQ(asked.max_since(250), 1.2);
  asked.announce(0.3, 500);
  EXPECT_EQ(asked.max_since(600), 1) << "what is slowed down may still be going at full feed";
  asked.forget_before(600);
  EXPECT_EQ(asked.max_since(600), 1);
}

TEST(SentPrograms, AreRemovedOnlyWhereTheyWereMadeAndNobodyAsksForThemAnyMore) {
  const process::ScratchFolder folder;
  const auto made = [&](const char* name) {
    const auto file = folder.path() / name;
    std::ofstream(file) << "FINI";
    return file.string();
  };
  const std::string mine = made("a"), yours = made("b"), last = made("c");
  SentPrograms sent;
  sent.announce(mine, true, 100);
  sent.announce(yours, false, 200);
  sent.announce(last, true, 300);
  EXPECT_EQ(sent.at(50), "");
  EXPECT_EQ(sent.at(150), mine);
  sent.forget_before(150);
  EXPECT_TRUE(std::filesystem::exists(mine));
  sent.forget_before(350);
  EXPECT_EQ(sent.at(350), last);
  EXPECT_FALSE(std::filesystem::exists(mine));
  EXPECT_TRUE(std::filesystem::exists(yours));
  EXPECT_TRUE(std::filesystem::exists(last));
}

TEST(Plant, StartsTheServiceWithTheRealTimeThatItWasGiven) {
  const process::ScratchFolder folder;
  PlantOptions options{.machine = process::shipped_file("machines/lai.toml").string(),
                       .tools = process::shipped_file("tools.toml").string()};
  options.realtime = {.mode = config::RealtimeMode::kEnforce, .cpu = 3, .io_priority = 44};
  options.bridge_cycles = 7;
  const auto file = folder.path() / "service.toml";
  std::ofstream(file) << service_text(options);
  const config::ServiceConfig service = config::load_service(file);
  EXPECT_EQ(service.machine, options.machine);
  EXPECT_EQ(service.tools, options.tools);
  EXPECT_EQ(service.realtime.mode, config::RealtimeMode::kEnforce);
  EXPECT_EQ(service.realtime.cpu, 3);
  EXPECT_EQ(service.realtime.io_priority, 44);
  EXPECT_EQ(service.bridge_cycles, 7);
  std::ofstream(file) << service_text({.machine = options.machine});
  EXPECT_EQ(config::load_service(file).realtime.mode, config::RealtimeMode::kBestEffort);
  EXPECT_FALSE(config::load_service(file).bridge_cycles);
}

/// Rows of `count` cycles in one state, from `first` on.
std::string rows(const char* state, int first, int count, int epoch = 1) {
  std::string text;
  for (int i = first; i < first + count; ++i) {
    text += std::to_string(i) + "," + std::to_string(i * 1000) + ",0.5," + state + "," +
            std::to_string(epoch) + "\n";
  }
  return text;
}

class SegmentsTest : public testing::Test {
 protected:
  /// Feeds `text` in portions that never end with a line.
  void feed(const std::string& text) {
    for (std::size_t i = 0; i < text.size(); i += 7) segments_.add(text.substr(i, 7));
  }
  static std::string text_of(const Segment& segment) {
    std::ifstream file(segment.file);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  static constexpr const char* kHeader = "cycle,due_ns,x_mm,state,epoch\n";
  process::ScratchFolder folder_;
  std::vector<Segment> reported_;
  Segments segments_{folder_.path(), [this](const Segment& one) { reported_.push_back(one); }};
};

TEST_F(SegmentsTest, EndWhereTheMachineRestsBehindAProgram) {
  const std::string first =
      rows("ready", 0, 100) + rows("running", 100, 30) + rows("ready", 130, 50);
  feed(kHeader + first + rows("ready", 180, 20));
  ASSERT_EQ(reported_.size(), 1U);
  EXPECT_TRUE(reported_[0].has_run);
  EXPECT_FALSE(reported_[0].is_aborted);
  EXPECT_EQ(reported_[0].rows, 180U);
  EXPECT_EQ(reported_[0].begin_ns, 100'000);
  EXPECT_EQ(text_of(reported_[0]), kHeader + first);
  feed(rows("running", 200, 5) + rows("fault_stop", 205, 5) + rows("fault", 210, 50));
  ASSERT_EQ(reported_.size(), 2U);
  EXPECT_TRUE(reported_[1].is_aborted);
  EXPECT_NE(reported_[1].file, reported_[0].file);
  EXPECT_EQ(reported_[1].rows, 80U);
}

TEST_F(SegmentsTest, AreAbortedWhereTheMachineRestsInTheNextEpoch) {
  feed(kHeader + rows("ready", 0, 10) + rows("running", 10, 30) + rows("ready", 40, 60, 2));
  feed(rows("running", 100, 30, 2) + rows("ready", 130, 60, 2));
  ASSERT_EQ(reported_.size(), 2U);
  EXPECT_TRUE(reported_[0].is_aborted) << "an abort at rest takes no cycle";
  EXPECT_FALSE(reported_[1].is_aborted);
}

TEST_F(SegmentsTest, EndWithTheServiceWithoutTheRowThatWasBeingWritten) {
  feed(kHeader + rows("running", 0, 10) + "10,100");
  segments_.cut_off();
  ASSERT_EQ(reported_.size(), 1U);
  EXPECT_TRUE(reported_[0].is_aborted);
  EXPECT_EQ(reported_[0].rows, 10U);
  feed(kHeader + rows("off", 0, 10));
  segments_.cut_off();
  ASSERT_EQ(reported_.size(), 2U);
  EXPECT_FALSE(reported_[1].has_run);
}

SoakReport good_report() {
  SoakReport report;
  report.finished = 3;
  Life life;
  life.has_first = true;
  life.first.process = {.resident_mib = 30, .threads = 15, .files = 20};
  life.last = life.first;
  life.max_resident_mib = 30;
  report.lives.push_back(life);
  return report;
}

TEST(SoakReport, SaysThatAnInterruptedSoakPassedSoFarAndNoMore) {
  SoakReport report = good_report();
  report.is_over = true;
  EXPECT_NE(to_text(report).find("\nPASS: 0 violations"), std::string::npos) << to_text(report);
  EXPECT_NE(to_text(report).find("; 1 of 8 budgets checked\n"), std::string::npos)
      << to_text(report);
  report.is_interrupted = true;
  report.elapsed_s = 120;
  report.asked_s = 28'800;
  EXPECT_FALSE(report.passed());
  EXPECT_NE(to_text(report).find("\nPASS so far, interrupted after 120 s of 28800 s: "),
            std::string::npos)
      << to_text(report);
  EXPECT_NE(to_json(report).find("\"passed\": false"), std::string::npos);
  report.violate("too fast", "part.cl");
  EXPECT_NE(to_text(report).find("\nFAIL, interrupted after"), std::string::npos);
}

TEST(SoakReport, PassesOnlyWhereNothingWasWrongAndSomethingWasDone) {
  EXPECT_TRUE(good_report().passed()) << to_text(good_report());
  EXPECT_FALSE(SoakReport{}.passed());
  SoakReport violated = good_report();
  violated.violate("too fast", "part.cl");
  EXPECT_FALSE(violated.passed());
  SoakReport stalled = good_report();
  stalled.host_faults = 1;
  EXPECT_FALSE(stalled.passed());
  EXPECT_NE(to_text(stalled).find("HOST NOT FIT: 1 Faults"), std::string::npos);
  EXPECT_NE(to_text(stalled).find("host not watched: no right to real time"), std::string::npos);
  EXPECT_NE(to_text(violated).find("VIOLATION: too fast (part.cl)"), std::string::npos);
  SoakReport grown = good_report();
  grown.lives[0].last.process.resident_mib = 32;
  EXPECT_FALSE(grown.passed());
  SoakReport large = good_report();
  large.lives[0].max_resident_mib = 65;
  EXPECT_FALSE(large.passed());
  large.allowed = load_growth_budgets(true);
  EXPECT_TRUE(large.passed()) << "traces take some";
  SoakReport threads = good_report();
  ++threads.lives[0].last.process.threads;
  EXPECT_FALSE(threads.passed());
}

}  // namespace
}  // namespace meridian::soak
