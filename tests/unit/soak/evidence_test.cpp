// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/watch/evidence.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "service/host/process/programs.hpp"
#include "service/host/soak/plant.hpp"

namespace meridian::soak {
namespace {

namespace fs = std::filesystem;

class EvidenceTest : public testing::Test {
 protected:
  [[nodiscard]] fs::path file(const char* name, const char* text = "new") const {
    fs::create_directories(kept_);
    const auto path = kept_ / name;
    std::ofstream(path) << text;
    return path;
  }
  [[nodiscard]] std::string read(const char* name) const {
    std::ifstream in(kept_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  process::ScratchFolder folder_;
  fs::path kept_ = folder_.path() / "soak.kept";
};

TEST_F(EvidenceTest, IsNamedByItsNumberAndOfTheFirstFindsAlone) {
  const auto from = file("source");
  Evidence evidence(kept_, "recording", 2);
  EXPECT_EQ(evidence.keep({{from, ".csv"}, {folder_.path() / "none", ".cl"}}),
            kept_ / "recording1");
  EXPECT_EQ(evidence.keep({{from, ".csv"}, {from, ".cl"}}), kept_ / "recording2");
  EXPECT_EQ(evidence.keep({{from, ".csv"}}), "");
  EXPECT_EQ(read("recording1.csv"), "new");
  EXPECT_EQ(read("recording2.cl"), "new");
  EXPECT_EQ(Evidence("", "recording", 2).keep({{from, ".csv"}}), "");
  EXPECT_EQ(evidence.keep({{folder_.path() / "none", ".csv"}}), "");
}

TEST_F(EvidenceTest, OfASoakBeforeIsGoneAndNothingElse) {
  const auto old = {file("recording1.csv", "old"), file("recording12.cl", "old")};
  const auto others = {file("recording.csv"), file("recording-of-mine.csv"), file("fault1.drives"),
                       file("recording1")};
  const Evidence evidence(kept_, "recording", 2);
  for (const auto& path : old) EXPECT_FALSE(fs::exists(path)) << path;
  for (const auto& path : others) EXPECT_TRUE(fs::exists(path)) << path;
}

class PlantTest : public EvidenceTest {
 protected:
  PlantTest() {
    fs::create_directories(flights_);
    std::ofstream(work_ / "service.log") << "said";
  }
  /// A flight that was written `age` ago.
  void fly(const char* name, std::chrono::milliseconds age = {}) const {
    std::ofstream(flights_ / name) << name;
    fs::last_write_time(flights_ / name, fs::file_time_type::clock::now() - age);
  }

  fs::path work_ = folder_.path() / "work", flights_ = work_ / "flights";
  Plant plant_{{.machine = "machine.toml", .domain = 221}, work_, kept_};
};

TEST_F(PlantTest, KeepsTheFlightOfTheFaultWhoseLogsItKept) {
  fly("fault-20260101T000001Z-drive_fault.csv", std::chrono::minutes(1));
  EXPECT_FALSE(plant_.awaits_flight());
  EXPECT_EQ(plant_.keep_logs(), kept_ / "fault1");
  EXPECT_EQ(read("fault1.service.log"), "said");
  EXPECT_TRUE(plant_.awaits_flight());
  fly("fault-20260101T000102Z-feedback_lost.csv");
  fly("fault-20260101T000102Z-feedback_lost.txt");
  plant_.keep_flight();
  EXPECT_EQ(read("fault1.flight.csv"), "fault-20260101T000102Z-feedback_lost.csv");
  EXPECT_FALSE(plant_.awaits_flight());
}

TEST_F(PlantTest, TakesNoFlightOfAFaultBefore) {
  fly("fault-20260101T000001Z-feedback_lost.csv", std::chrono::minutes(1));
  EXPECT_EQ(plant_.keep_logs(), kept_ / "fault1");
  plant_.keep_flight();
  EXPECT_FALSE(fs::exists(kept_ / "fault1.flight.csv"));
}

TEST_F(PlantTest, KeepsAFlightThatIsStillAwaitedWhenTheNextFaultComes) {
  (void)plant_.keep_logs();
  fly("fault-20260101T000001Z-feedback_lost.csv");
  EXPECT_EQ(plant_.keep_logs(), kept_ / "fault2");
  EXPECT_EQ(read("fault1.flight.csv"), "fault-20260101T000001Z-feedback_lost.csv");
}

}  // namespace
}  // namespace meridian::soak
