// SPDX-License-Identifier: Apache-2.0
#include "integration/checked_part.hpp"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "integration/fault_part.hpp"
#include "integration/plant.hpp"
#include "integration/witness.hpp"
#include "service/machine/file/machine_file.hpp"

/// The check of the tests beside this one finds what it is there for.
namespace meridian::test {
namespace {

class CheckedPart : public testing::Test {
 protected:
  void SetUp() override { std::ofstream(file()) << lines.text(); }
  [[nodiscard]] std::string file() const { return (plant.folder() / "part.cls").string(); }
  [[nodiscard]] PartAsked asked() const { return {model, tools, file(), lines.motions}; }
  /// Simulates the part from that line on; 0: all of it.
  [[nodiscard]] PartCut cut_from(std::uint32_t line) const {
    const std::string recording = plant.folder() / ("from" + std::to_string(line) + ".csv");
    std::vector<std::string> words = {"meridian",      "simulate", file(),   "--machine",
                                      plant.machine(), "--record", recording};
    if (line > 0) words.insert(words.end(), {"--from-line", std::to_string(line)});
    Process simulate(words, plant.folder() / "simulate.log");
    EXPECT_EQ(simulate.wait(milliseconds(20'000)), 0) << simulate.said();
    return {.recording = recording, .from_line = line};
  }
  /// All of it, broken off in the middle of that line.
  [[nodiscard]] PartCut cut_into(std::uint32_t line) const {
    PartCut cut = cut_from(0);
    cut.is_finished = false;
    auto recording = record::RecordingReader::open(cut.recording, model);
    std::uint64_t first = 0, last = 0;
    for (record::RecordingRow row; recording->next(row).value_or(false);) {
      if (row.line != line) continue;
      first = first == 0 ? row.cycle : first;
      last = row.cycle;
    }
    cut.to_cycle = (first + last) / 2;
    return cut;
  }

  const Phase phase{"", Phase::Where::kCut};
  const FaultPart lines{phase};
  const std::uint32_t middle = lines.section + 2;
  const Plant plant;
  const MachineModel model = config::load_machine(plant.machine());
  const ToolTable tools;
};

TEST_F(CheckedPart, SeesNothingWrongWhereEveryLineIsCut) {
  const LinesCut before = check(asked(), cut_into(middle));
  EXPECT_EQ(before.last, middle);
  EXPECT_FALSE(before.is_last_done);
  const LinesCut after = check(asked(), cut_from(middle));
  EXPECT_EQ(after.last, lines.motions.back());
  EXPECT_TRUE(after.is_last_done);
  expect_seam(asked(), before, after, middle);
}

TEST_F(CheckedPart, SeesALineThatIsLostAndOneThatIsCutTwice) {
  const LinesCut before = check(asked(), cut_into(middle));
  const LinesCut later = check(asked(), cut_from(middle + 1));
  EXPECT_NONFATAL_FAILURE(expect_seam(asked(), before, later, middle + 1), "lost between them");
  const LinesCut earlier = check(asked(), cut_from(middle - 1));
  EXPECT_NONFATAL_FAILURE(expect_seam(asked(), before, earlier, middle - 1), "cut twice");
}

TEST_F(CheckedPart, SeesAPoseBesideThePathACycleAndAnEndThatAreMissing) {
  const PartCut cut = cut_from(0);
  auto recording = record::RecordingReader::open(cut.recording, model);
  std::vector<Setpoint> seen;
  for (record::RecordingRow row; recording->next(row).value_or(false);) {
    Setpoint setpoint;
    setpoint.cycle = row.cycle;
    setpoint.due_ns = row.due_ns;
    setpoint.line = row.line;
    setpoint.flags = row.flags;
    setpoint.position = row.joints;
    std::copy_n(row.velocity.begin(), setpoint.velocity.size(), setpoint.velocity.begin());
    seen.push_back(setpoint);
  }
  PartCut spoilt = cut;
  spoilt.recording = plant.folder() / "spoilt.csv";
  seen[seen.size() / 2].position[0] += 0.05;
  write_recording(seen, model, spoilt.recording);
  EXPECT_NONFATAL_FAILURE((void)check(asked(), spoilt), "off the path");
  seen[seen.size() / 2].position[0] -= 0.05;
  seen.erase(seen.begin() + static_cast<long>(seen.size() / 3));
  write_recording(seen, model, spoilt.recording);
  EXPECT_NONFATAL_FAILURE((void)check(asked(), spoilt), "1 cycles are missing, 0 allowed");
  spoilt.max_missing = 1;
  (void)check(asked(), spoilt);
  PartCut short_one = cut_into(middle);
  short_one.is_finished = true;
  EXPECT_NONFATAL_FAILURE((void)check(asked(), short_one), "FAIL");
}

}  // namespace
}  // namespace meridian::test
