// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "service/machine/file/machine_file.hpp"
#include "support/text_file.hpp"

namespace meridian::config {
namespace {

/// One mistake: the first occurrence of `good` in the shipped file is replaced by `bad`. Value,
/// allowed and remedy are looked for inside those of the message.
struct Mistake {
  const char* name;
  const char* good;
  const char* bad;
  const char* key;
  const char* value;
  const char* allowed;
  const char* remedy;
  const char* file = "lai";  ///< shipped machine that is changed
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class WrongMachineFile : public testing::TestWithParam<Mistake> {};

TEST_P(WrongMachineFile, IsRefusedWithLineKeyValueRangeAndRemedy) {
  const Mistake& mistake = GetParam();
  std::string text = test::read_text(MERIDIAN_SOURCE_DIR "/deploy/machines/" +
                                     std::string(mistake.file) + ".toml");
  const std::size_t at = text.find(mistake.good);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(mistake.good).size(), mistake.bad);
  const test::TextFile file(text);
  try {
    (void)load_machine(file.path());
    FAIL() << "the file was accepted";
  } catch (const ConfigError& error) {
    const ConfigFault& fault = error.fault();
    EXPECT_EQ(fault.file, file.path().string());
    EXPECT_EQ(fault.key, mistake.key);
    EXPECT_NE(fault.value.find(mistake.value), std::string::npos) << fault.value;
    EXPECT_NE(fault.allowed.find(mistake.allowed), std::string::npos) << fault.allowed;
    EXPECT_NE(fault.remedy.find(mistake.remedy), std::string::npos) << fault.remedy;
    EXPECT_FALSE(fault.allowed.empty());
    EXPECT_FALSE(fault.remedy.empty());
    const bool has_value = !fault.value.empty() && *mistake.bad != '\0';
    if (has_value) {  // the line named is one of those that were changed
      const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n');
      const std::string bad = mistake.bad;
      EXPECT_GE(fault.line, line);
      EXPECT_LE(fault.line, line + std::count(bad.begin(), bad.end(), '\n'));
    }
    const std::string what = error.what();
    EXPECT_EQ(what.find(fault.file + ":"), 0) << what;
    for (const std::string& part : {fault.key, fault.value, fault.allowed, fault.remedy}) {
      EXPECT_NE(what.find(part), std::string::npos) << what;
    }
  }
}

/// Of the actuator stage.
const Mistake kStageMistakes[] = {
    {"StageKind", "kind = \"trailing\"", "kind = \"hexapod\"", "stage.kind", "hexapod",
     "\"trailing\", \"scissor\", \"pin-slot\"", "choose", "lai-hybrid"},
    {"StageOfNoJoint", "linear = \"b2\"", "linear = \"x\"", "stage.linear", "x",
     "a linear joint of the machine: b3 b2 b4", "name the linear joint", "lai-hybrid"},
    {"StageTurnsASlide", "rotary = \"theta1\"", "rotary = \"b4\"", "stage.rotary", "b4",
     "theta1 theta2", "name the rotary joint", "lai-hybrid"},
    {"StageSignZero", "turn_sign = -1", "turn_sign = 0", "stage.turn_sign", "0", "1 or -1",
     "grow together", "lai-hybrid"},
    {"StageOffsetTooFar", "slide_offset_mm = 60", "slide_offset_mm = 1e6", "stage.slide_offset_mm",
     "1000000", "-100000 to 100000", "number", "lai-hybrid"},
    {"StageWithoutRadius", "radius_mm = 150", "radius_mm = 0", "stage.radius_mm", "0",
     "0.001 to 100000", "number", "lai-hybrid"},
    {"StageRailBelow", "rail_mm = 150", "rail_mm = -1", "stage.rail_mm", "-1", "0 to 100000",
     "distance", "lai-hybrid"},
    {"StageRodTooShort", "rod_mm = 300", "rod_mm = 75", "stage.rod_mm", "75", "above 78.75 mm",
     "square to its rail", "lai-hybrid"},
    {"StageRods", "rods = \"ahead\"", "rods = \"up\"", "stage.rods", "up", "\"ahead\", \"behind\"",
     "choose", "lai-hybrid"},
    {"StageTurnsTooFar", "turn_max_deg = 60", "turn_max_deg = 88", "stage.turn_max_deg", "88",
     "below 87.", "dead point", "lai-hybrid"},
    {"StageTurnsLessThanTheJoint", "turn_max_deg = 60", "turn_max_deg = 59", "stage.turn_max_deg",
     "59", "at least 60 deg, the travel of theta1", "travel_deg", "lai-hybrid"},
    {"StageDriveNamedLikeAJoint", "drives = [\"u1\", \"u2\"]", "drives = [\"u1\", \"b3\"]",
     "stage.drives", "b3", "two names that nothing else has", "sliders", "lai-hybrid"},
    {"StageOneDrive", "drives = [\"u1\", \"u2\"]", "drives = [\"u1\"]", "stage.drives", "u1", "2",
     "sliders", "lai-hybrid"},
    {"StageDriveWithoutLimits", "[stage.u1]", "[stage.u3]", "stage.u1", "", "", "", "lai-hybrid"},
    {"StageDriveNotAtHome", "travel_mm = [-625, 45]", "travel_mm = [-200, 45]",
     "stage.u1.travel_mm", "-200", "holds -300 mm", "home", "lai-hybrid"},
    {"StageDriveOfHome", "travel_mm = [-625, 45]", "travel_mm = [-625, 45]\nhome_mm = 0",
     "stage.u1.home_mm", "0", "", "", "lai-hybrid"},
    {"StageDriveWord", "nc_word = \"U\"", "nc_word = \"U123\"", "stage.u1.nc_word", "U123",
     "one of X Y Z A B C U V W", "address", "lai-hybrid"},
    {"StageDriveFasterThanAnything", "jerk_mm_per_s3 = 80000", "jerk_mm_per_s3 = 0",
     "stage.u1.jerk_mm_per_s3", "0", "0.001", "number", "lai-hybrid"},
};

INSTANTIATE_TEST_SUITE_P(Stage, WrongMachineFile, testing::ValuesIn(kStageMistakes),
                         [](const auto& mistake) { return std::string(mistake.param.name); });

/// The fault of lai-hybrid.toml where the first `from` is `to` instead.
struct Change {
  const char* from;
  const char* to;
};
ConfigFault fault_of_hybrid(const std::vector<Change>& changes) {
  std::string text = test::read_text(MERIDIAN_SOURCE_DIR "/deploy/machines/lai-hybrid.toml");
  for (const Change& change : changes) {
    text.replace(text.find(change.from), std::string(change.from).size(), change.to);
  }
  try {
    (void)parse_machine(text, "hybrid");
  } catch (const ConfigError& error) {
    return error.fault();
  }
  return {};
}

TEST(WrongMachineFile, AScissorOnOneRailTurnsAsFarAsItsDeadPoint) {
  const ConfigFault fault = fault_of_hybrid(
      {{"kind = \"trailing\"", "kind = \"scissor\""}, {"turn_max_deg = 60", "turn_max_deg = 75"}});
  EXPECT_EQ(fault.key, "stage.turn_max_deg");
  EXPECT_NE(fault.allowed.find("below 6"), std::string::npos) << fault.allowed;
}

TEST(WrongMachineFile, AStageOfAJointThatTurnsWithoutEndIsRefused) {
  const ConfigFault fault = fault_of_hybrid({{"travel_deg = [-60, 60]", "endless = true"}});
  EXPECT_EQ(fault.key, "stage.rotary");
  EXPECT_NE(fault.remedy.find("give theta1 travel_deg"), std::string::npos) << fault.remedy;
}

TEST(WrongMachineFile, AWordOfAJointThatAStageCarriesIsRefused) {
  const ConfigFault fault = fault_of_hybrid({{"[joints.b2]", "[joints.b2]\nnc_word = \"Y\""}});
  EXPECT_EQ(fault.key, "stage.linear");
  EXPECT_NE(fault.remedy.find("move nc_word from joints.b2"), std::string::npos) << fault.remedy;
}

TEST(WrongMachineFile, GeometryOfAStageThatIsNoneIsRefused) {
  const ConfigFault fault = fault_of_hybrid({{"kind = \"trailing\"", "kind = \"identity\""}});
  EXPECT_EQ(fault.key.find("stage."), 0U) << fault.key;
}

const Mistake kMistakes[] = {
    {"NotToml", "name = \"lai\"", "name = lai machine", "", "not TOML", "TOML 1.0", "mend"},
    {"DoubleKey", "version = \"1\"", "name = \"lai\"", "", "not TOML", "TOML 1.0", "mend"},
    {"NoName", "name = \"lai\"\n", "", "machine.name", "", "text", "name the machine"},
    {"EmptyName", "name = \"lai\"", "name = \"\"", "machine.name", "", "not empty", "name"},
    {"NameIsANumber", "name = \"lai\"", "name = 5", "machine.name", "5", "quotes", "name"},
    {"CycleTooShort", "cycle_us = 1000", "cycle_us = 100", "machine.cycle_us", "100", "125 to 4000",
     "number"},
    {"CycleTooLong", "cycle_us = 1000", "cycle_us = 4001", "machine.cycle_us", "4001",
     "125 to 4000", "number"},
    {"CycleIsText", "cycle_us = 1000", "cycle_us = \"1000\"", "machine.cycle_us", "1000",
     "125 to 4000", "number"},
    {"CycleIsNotANumber", "cycle_us = 1000", "cycle_us = nan", "machine.cycle_us", "nan",
     "125 to 4000", "number"},
    {"UnknownUnit", "default_unit = \"none\"", "default_unit = \"cm\"", "machine.default_unit",
     "cm", "\"none\", \"mm\", \"inch\"", "choose"},
    {"FeedZero", "max_feed_mm_per_min = 30000", "max_feed_mm_per_min = 0",
     "machine.max_feed_mm_per_min", "0", "0.001 to 1000000", "number"},
    {"FeedInfinite", "max_feed_mm_per_min = 30000", "max_feed_mm_per_min = inf",
     "machine.max_feed_mm_per_min", "inf", "0.001 to 1000000", "number"},
    {"ClearanceNegative", "clearance_mm = 50", "clearance_mm = -1", "machine.clearance_mm", "-1",
     "0 to 10000", "number"},
    {"ToolNegative", "tool_length_mm = 110", "tool_length_mm = -110", "machine.tool_length_mm",
     "-110", "0 to 10000", "number"},
    {"BridgeHalf", "bridge_cycles = 3", "bridge_cycles = 3.5", "machine.bridge_cycles", "3.5",
     "whole number", "decimal point"},
    {"UnknownFamily", "family = \"lai\"", "family = \"puma\"", "kinematics.family", "puma",
     "\"lai\"", "choose"},
    {"MissingConstant", "l4_mm = 30\n", "", "kinematics.l4_mm", "", "-100000 to 100000", "add it"},
    {"PivotNegative", "l5_mm = 140", "l5_mm = -140", "kinematics.l5_mm", "-140", "0 to 100000",
     "number"},
    {"KeyWithoutUnit", "b5_mm = 20", "b5 = 20", "kinematics.b5_mm", "", "-100000", "add it"},
    {"UnknownConstant", "b5_mm = 20", "b5_mm = 20\nb6_mm = 1", "kinematics.b6_mm", "1", "b5_mm",
     "did you mean"},
    {"NoJoint", "[joints.b2]", "[joints.b9]", "joints.b2", "", "table", "add it"},
    {"UnknownJoint", "[joints.b3]", "[joints.x]\n[joints.b3]", "joints.x", "table", "b3", ""},
    {"TravelTurnedOver", "travel_mm = [-600, 600]", "travel_mm = [600, -600]",
     "joints.b3.travel_mm", "[ 600, -600 ]", "minimum below maximum", "swap"},
    {"TravelEmpty", "travel_deg = [-60, 60]", "travel_deg = [60, 60]", "joints.theta2.travel_deg",
     "60", "minimum below maximum", "swap"},
    {"TravelOfOneNumber", "travel_mm = [-600, 600]", "travel_mm = 600", "joints.b3.travel_mm",
     "600", "[minimum, maximum]", "brackets"},
    {"TravelOfThree", "travel_mm = [-600, 600]", "travel_mm = [0, 1, 2]", "joints.b3.travel_mm",
     "2", "[minimum, maximum]", "brackets"},
    {"TravelWithText", "travel_mm = [-600, 600]", "travel_mm = [-600, \"600\"]",
     "joints.b3.travel_mm", "600", "-100000 to 100000", ""},
    {"ChainFromTheTool", "chain = [\"C\", \"A\", \"X\", \"Y\", \"Z\"]",
     "chain = [\"X\", \"Y\", \"Z\", \"C\", \"A\"]", "kinematics.chain", "'C'",
     "joint 1, on the head, stands before joint 4, under the workpiece", "order", "trunnion-ac"},
    {"ChainWithTheHeadAmidTheTable", "chain = [\"C\", \"X\", \"Y\", \"Z\", \"B\"]",
     "chain = [\"C\", \"B\", \"X\", \"Y\", \"Z\"]", "kinematics.chain", "'B'",
     "joint 2, on the head, stands before joint 3, under the workpiece", "order", "head-table-bc"},
    {"TravelMissing", "travel_deg = [-720, 720]\n", "", "joints.theta1.travel_deg", "",
     "[minimum, maximum]", "endless = true"},
    {"TravelInWrongUnit", "travel_deg = [-60, 60]", "travel_rad = [-1, 1]",
     "joints.theta2.travel_deg", "", "[minimum, maximum]", "endless"},
    {"TravelAndEndless", "travel_deg = [-720, 720]", "travel_deg = [-720, 720]\nendless = true",
     "joints.theta1.travel_deg", "720", "either", "remove"},
    {"EndlessLinear", "travel_mm = [-600, 600]", "travel_mm = [-600, 600]\nendless = true",
     "joints.b3.endless", "true", "travel_mm", ""},
    {"EndlessIsText", "travel_deg = [-720, 720]", "endless = \"yes\"", "joints.theta1.endless",
     "yes", "true, false", "quotes"},
    {"VelocityNegative", "velocity_mm_per_s = 300", "velocity_mm_per_s = -300",
     "joints.b3.velocity_mm_per_s", "-300", "0.001", "number"},
    {"VelocityZero", "velocity_deg_per_s = 60", "velocity_deg_per_s = 0",
     "joints.theta1.velocity_deg_per_s", "0", "0.001", "number"},
    {"VelocityPerMinute", "velocity_mm_per_s = 300", "velocity_mm_per_min = 18000",
     "joints.b3.velocity_mm_per_s", "", "0.001",
     "is velocity_mm_per_min the same in another unit? Convert it"},
    {"JerkMissing", "jerk_mm_per_s3 = 60000\n", "", "joints.b3.jerk_mm_per_s3", "", "0.001", "add"},
    {"MisspeltNeeded", "fault_jerk_mm_per_s3", "fault_jrk_mm_per_s3",
     "joints.b3.fault_jerk_mm_per_s3", "", "0.001", "did you mean it by fault_jrk_mm_per_s3"},
    {"Misspelt", "jerk_mm_per_s3 = 60000", "jerk_mm_per_s3 = 60000\nhome_m = 0", "joints.b3.home_m",
     "0", "home_mm", "did you mean home_mm?"},
    {"FaultStopSofter", "fault_acceleration_mm_per_s2 = 6000", "fault_acceleration_mm_per_s2 = 60",
     "joints.b3.fault_acceleration_mm_per_s2", "60", "at least acceleration_mm_per_s2", "softer"},
    {"FaultJerkSofter", "fault_jerk_mm_per_s3 = 240000", "fault_jerk_mm_per_s3 = 6",
     "joints.b3.fault_jerk_mm_per_s3", "6", "at least jerk_mm_per_s3", "softer"},
    {"FollowingErrorZero", "following_error_mm = 5", "following_error_mm = 0",
     "joints.b3.following_error_mm", "0", "1e-06", "number"},
    {"HomeOutsideTravel", "home_mm = 0", "home_mm = 601", "joints.b3.home_mm", "601",
     "inside travel_mm", "into travel"},
    {"ToleranceZero", "tip_mm = 0.01", "tip_mm = 0", "tolerances.tip_mm", "0", "0.001 to 10", ""},
    {"TipToleranceBelowWhatIsPlannedFor", "tip_mm = 0.01", "tip_mm = 0.0005", "tolerances.tip_mm",
     "0.0005", "0.001 to 10", ""},
    {"AxisToleranceBelowWhatIsPlannedFor", "axis_deg = 0.1", "axis_deg = 0.005",
     "tolerances.axis_deg", "0.005", "0.00573 to 10", ""},
    {"ToleranceInRadian", "axis_deg = 0.1", "axis_rad = 0.1", "tolerances.axis_deg", "", "0.00573",
     "add it"},
    {"RewindByItsOldName", "[rewind]", "[unwind]", "unwind", "table", "rewind", "[rewind]"},
    {"RewindUnknown", "policy = \"refuse\"", "policy = \"jump\"", "rewind.policy", "jump",
     "\"refuse\", \"retract\"", ""},
    {"RewindWithoutItsRetract", "policy = \"refuse\"", "policy = \"retract\"", "rewind.retract_mm",
     "", "", "how far the tool leaves"},
    {"RewindBesideThePart", "policy = \"refuse\"", "policy = \"retract\"\nretract_mm = 0.5",
     "rewind.retract_mm", "0.5", "1 to 10000", ""},
    {"RewindRetractOfNoUse", "policy = \"refuse\"", "policy = \"refuse\"\nretract_mm = 50",
     "rewind.retract_mm", "50", "nothing beside", "retract"},
    {"UnknownPolicy", "policy = \"ease\"", "policy = \"jump\"", "pole.policy", "jump", "\"ease\"",
     "choose"},
    {"FrameOfTwo", "origin_mm = [0, 0, 0]", "origin_mm = [0, 0]", "frame.origin_mm", "0",
     "[x, y, z]", "three numbers"},
    {"FrameTooFar", "rotation_deg = [0, 0, 0]", "rotation_deg = [0, 0, 361]", "frame.rotation_deg",
     "361", "-360 to 360", ""},
    {"UnknownTable", "[tolerances]", "[tolerance]\n[tolerances]", "tolerance", "table",
     "tolerances", "did you mean tolerances?"},
    {"TableIsANumber", "[pole]\npolicy = \"ease\"", "[pole2]\npolicy = \"ease\"", "pole", "",
     "a table [pole]", "add it"},
};

INSTANTIATE_TEST_SUITE_P(Every, WrongMachineFile, testing::ValuesIn(kMistakes),
                         [](const auto& given) { return std::string(given.param.name); });

TEST(WrongMachineFile, ThatIsNotThereIsRefusedByName) {
  try {
    (void)load_machine("/nowhere/machine.toml");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.fault().file, "/nowhere/machine.toml");
    EXPECT_NE(std::string(error.what()).find("no such file"), std::string::npos);
    EXPECT_NE(error.fault().remedy.find("path"), std::string::npos);
  }
}

TEST(WrongMachineFile, ThatIsBinaryOrEmptyIsRefused) {
  const test::TextFile binary(std::string_view("\x00\xff\xfe\x01[machine", 12));
  EXPECT_THROW((void)load_machine(binary.path()), ConfigError);
  const test::TextFile empty("");
  try {
    (void)load_machine(empty.path());
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.fault().key, "machine");
  }
}

TEST(WrongMachineFile, IsRefusedAtEveryKeyThatIsTakenAway) {
  // Keys that have a default may be missing; every other line of the file is needed.
  const std::vector<std::string> optional = {
      "version",         "default_unit", "starve_auto_resume_s",
      "bridge_cycles",   "origin_mm",    "rotation_deg",
      "turn_offset_deg", "rods",         "slide_sign",
      "slide_offset_mm", "turn_sign",    "nc_word",
      "transition"};
  const std::string text = test::read_text(MERIDIAN_SOURCE_DIR "/deploy/machines/lai-hybrid.toml");
  int needed = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const std::string line = text.substr(begin, end - begin);
    const std::string key = line.substr(0, line.find(' '));
    if (line.find(" = ") != std::string::npos && line[0] != '#') {
      const test::TextFile file(text.substr(0, begin) + text.substr(end));
      if (std::find(optional.begin(), optional.end(), key) != optional.end()) {
        EXPECT_NO_THROW((void)load_machine(file.path())) << line;
      } else {
        EXPECT_THROW((void)load_machine(file.path()), ConfigError) << line;
        ++needed;
      }
    }
    begin = end;
  }
  EXPECT_GT(needed, 50);
}

}  // namespace
}  // namespace meridian::config
