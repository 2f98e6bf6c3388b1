// SPDX-License-Identifier: Apache-2.0
// Every row of the table of Siemens names: it does what it is there for, or is refused by its name.
#include <gtest/gtest.h>

#include <algorithm>

#include "service/programs/nc/remedy.hpp"
#include "service/programs/nc/siemens/siemens_cycles.hpp"
#include "service/programs/nc/siemens/siemens_line.hpp"
#include "service/programs/nc/siemens/siemens_names.hpp"
#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

bool says(const ReadText& read, std::string_view text) {
  return read.error.find(text) != std::string::npos;
}

bool skips(const ReadText& read, std::string_view name) {
  const auto& skipped = read.summary.skipped;
  return std::any_of(skipped.begin(), skipped.end(),
                     [name](const auto& word) { return word.word == name; });
}

bool is_setting(std::string_view name) {
  const auto all = setting_names();
  return std::find(all.begin(), all.end(), name) != all.end();
}

/// A first point, the name in a line of its own, and a cut.
ReadText read_between(const std::string& line) {
  return read_siemens("G0 X0 Y0 Z20\n" + line + "\nG1 X9\n");
}

/// Two vectors under TRAORI, the name before them.
ReadText read_vectors(const std::string& name) {
  return read_siemens("TRAORI\n" + name +
                      "\nG0 X0 Y0 Z9 A3=0 B3=0 C3=1\nG1 X9 A3=3 B3=0 C3=4\nTRAFOOF\n");
}

/// A quarter turn of the table under TRAORI, the name before it.
ReadText read_turn(const std::string& name) {
  return read_siemens("G0 A30 C0\nTRAORI\n" + name + "\nG0 X0 Y0 Z50\nG1 X90 C90\n",
                      siemens(on(shipped("trunnion-ac"))));
}

void expect_frame(const std::string& name) {
  const bool is_swivel = name == "CYCLE800";
  const ReadText read =
      is_swivel ? read_between("CYCLE800(0,\"\",0,57,5,0,0,0,0,90,0,0,0,-1)\nG0 X0 Y0 Z0")
                : read_between(name + (name.ends_with("ROT") ? " Z90" : " X5"));
  const bool is_rigid = name.ends_with("TRANS") || name.ends_with("ROT") || is_swivel;
  if (!is_rigid) {
    EXPECT_TRUE(says(read, name + ": ")) << name << ": " << read.error;
    EXPECT_TRUE(says(read, "let the CAM system output points without it")) << read.error;
    return;
  }
  ASSERT_EQ(read.error, "") << name;
  EXPECT_EQ(read.summary.frame_changes, 1U) << name;
  const Vector3 end = is_swivel                 ? Vector3(5, 9, 0)
                      : name.ends_with("TRANS") ? Vector3(14, 0, 20)
                                                : Vector3(0, 9, 20);
  EXPECT_LT((tip(read.motion().back()) - end).norm(), kTiny) << name;
}

void expect_row(const NameRow& row) {
  const std::string name(row.name);
  switch (row.kind) {
    case NameKind::kOn: {
      const ReadText read = read_vectors("");
      ASSERT_EQ(read.error, "") << name;
      EXPECT_NEAR(axis(read.motion()[1])[0], 0.6, kTiny) << name;
      break;
    }
    case NameKind::kOff:
      EXPECT_TRUE(says(read_vectors(name), "without tool-centre control")) << name;
      break;
    case NameKind::kGreatCircle:
      EXPECT_EQ(read_turn(name).motion().size(), 2U) << name << read_turn(name).error;
      break;
    case NameKind::kEvenJoints:
      EXPECT_GT(read_turn(name).motion().size(), 5U) << name << read_turn(name).error;
      break;
    case NameKind::kPart:
      EXPECT_EQ(read_vectors("ORIMKS\n" + name).error, "") << name << " takes ORIMKS back";
      break;
    case NameKind::kMachine:
      EXPECT_TRUE(says(read_vectors(name), "in the axes of the machine")) << name;
      break;
    case NameKind::kMachinePosition: {
      const ReadText read = read_siemens(name + " G0 Z0\nG0 X0 Y0 Z20\nG1 X9\n");
      EXPECT_EQ(read.error, "") << name;
      EXPECT_EQ(read.motion().size(), 2U) << name;
      break;
    }
    case NameKind::kNothing:
      for (const std::string& line : {name, name + "(1,2)"}) {
        if (line != name && is_setting(name)) continue;  // its value stands behind =
        const ReadText read = read_between(line);
        EXPECT_EQ(read.error, "") << line;
        EXPECT_EQ(read.motion().size(), 2U) << line;
        EXPECT_TRUE(skips(read, name)) << line;
      }
      break;
    case NameKind::kFrame:
      expect_frame(name);
      break;
    case NameKind::kModalCall:
      EXPECT_EQ(read_between(name + " CYCLE81(10,0,2,-9)").summary.holes, 1U) << name;
      break;
    case NameKind::kRefused: {
      const ReadText read = read_between(name);
      EXPECT_TRUE(says(read, name + ": " + std::string(row.note))) << name << ": " << read.error;
      EXPECT_TRUE(says(read, kMovesByCam)) << name << ": " << read.error;
      break;
    }
  }
}

TEST(SiemensNameRows, DoWhatTheyAreThereForOrAreRefused) {
  for (const NameRow& row : name_rows()) expect_row(row);
  EXPECT_GT(name_rows().size(), 100U);
}

TEST(SiemensNameRows, OfSettingsTakeTheirValue) {
  for (const std::string_view setting : setting_names()) {
    const std::string name(setting);
    for (const std::string& line : {name + "=0.5", name + "[X]=0.5"}) {
      const ReadText read = read_between(line);
      EXPECT_EQ(read.error, "") << line;
      EXPECT_TRUE(skips(read, name)) << line;
      EXPECT_EQ(read.motion().size(), 2U) << line;
    }
  }
  EXPECT_GT(setting_names().size(), 10U);
}

TEST(SiemensNameRows, OfCyclesDrillOrAreRefused) {
  for (int number = 60; number < 1000; ++number) {
    const std::string name = "CYCLE" + std::to_string(number);
    const auto rows = name_rows();
    const bool has_row =
        std::any_of(rows.begin(), rows.end(), [&](const NameRow& row) { return row.name == name; });
    if (has_row) continue;
    const ReadText read = read_between(name + "(10,0,2,-9)");
    if (is_siemens_drilling(name)) {
      EXPECT_EQ(read.error, "") << name;
      EXPECT_EQ(read.summary.holes, 1U) << name;
      continue;
    }
    EXPECT_TRUE(says(read, name + ": a cycle that only the control knows")) << read.error;
    EXPECT_TRUE(says(read, kMovesByCam)) << read.error;
  }
}

}  // namespace
}  // namespace meridian::nc
