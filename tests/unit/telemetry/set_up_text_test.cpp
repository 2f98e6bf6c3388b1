// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/journal/set_up_text.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "meridian/units.hpp"
#include "service/recording/telemetry/journal/journal_entry.hpp"
#include "service/recording/telemetry/journal/sealed_text.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::telemetry {
namespace {

/// A table of frames anywhere, with its seed.
WorkFrames drawn_frames(unsigned seed, int count) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> coordinate(-1e5, 1e5), angle(-360, 360);
  WorkFrames frames;
  for (int i = 0; i < count; ++i) {
    WorkFrame row;
    row.number = static_cast<std::uint8_t>(1 + engine() % WorkFrames::kMax);
    for (double& value : row.origin_mm) value = coordinate(engine);
    for (double& value : row.rotation_deg) value = angle(engine);
    put_text("vice " + std::to_string(i), row.name);
    EXPECT_EQ(frames.apply({FrameWord::kSet, row}), FrameFault::kNone);
    if (engine() % 2 == 0) {
      EXPECT_EQ(frames.apply({FrameWord::kSelect, row}), FrameFault::kNone);
    }
  }
  return frames;
}

TEST(SetUpText, ComesBackBitForBit) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    telemetry::SetUp set_up{drawn_frames(seed, static_cast<int>(seed % 60)), {}, {}};
    for (std::size_t i = 0; i < seed % 7; ++i) set_up.limits.put(i, -1.0 / (3 + seed), 1e5 / 7);
    for (unsigned n = 0; n < seed % 9; ++n) {
      KeepOutBox box;
      put_text("box " + std::to_string(n), box.name);
      box.joints = 1 + seed % 31;
      box.min.fill(-1.0 / (3 + seed));
      box.max.fill(1e5 / 7 + n);
      set_up.limits.put(box);
      set_up.limits.put(TipBox{true, {-1.0 / (3 + seed), 0, 1}, {1e5 / 7 + n, 2, 3}});
    }
    if (seed % 3 == 1) set_up.tools = std::string(seed * 40, 'x') + "\n# crc32c = 12345678\n";
    if (seed % 3 == 2) set_up.tools = "";
    const auto read = parse_set_up(to_text(set_up, "lai"), "lai");
    ASSERT_TRUE(read) << read.error();
    EXPECT_EQ(*read, set_up);
  }
}

TEST(SetUpText, OfAFullTableFitsIntoItsFile) {
  WorkFrames frames;
  WorkFrame row;
  row.origin_mm = row.rotation_deg = {-1.0 / 3.0 * 1e-300, -1.0 / 7.0 * 1e-300, -2.0 / 3.0};
  put_text(std::string(100, 'x'), row.name);
  for (int number = 1; number <= WorkFrames::kMax; ++number) {
    row.number = static_cast<std::uint8_t>(number);
    ASSERT_EQ(frames.apply({FrameWord::kSet, row}), FrameFault::kNone);
  }
  SoftLimits limits;
  for (std::size_t i = 0; i < kMaxJoints; ++i) limits.put(i, -1.0 / 3.0 * 1e-300, 2.0 / 3.0);
  KeepOutBox box;
  put_text(std::string(100, 'x'), box.name);
  box.joints = 0x3F;
  box.min.fill(-1.0 / 3.0 * 1e-300);
  box.max = box.min;
  for (int n = 0; n < KeepOut::kMax; ++n) limits.put(box);
  const double end = -1.0 / 3.0 * 1e-300;
  limits.put(TipBox{true, {end, end, end}, {end, end, end}});
  const std::string text =
      to_text({frames, std::string(dds::kToolFileBytes, 't'), limits}, std::string(64, 'm'));
  EXPECT_LT(text.size(), kMaxSetUpBytes);
  EXPECT_TRUE(parse_set_up(text, std::string(64, 'm')));
}

TEST(SetUpText, ThatIsTornOrChangedIsRefused) {
  const std::string text = to_text({drawn_frames(1, 5), "[[tool]]\nnumber = 4\n", {}}, "lai");
  for (std::size_t size = 0; size < text.size(); ++size) {
    EXPECT_FALSE(parse_set_up(text.substr(0, size), "lai")) << size;
  }
  for (std::size_t at = 0; at < text.size(); ++at) {
    std::string changed = text;
    changed[at] = changed[at] == '1' ? '2' : '1';
    EXPECT_FALSE(parse_set_up(changed, "lai")) << at;
  }
}

TEST(SetUpText, OfAnotherMachineIsRefusedByName) {
  const auto read = parse_set_up(to_text(telemetry::SetUp(), "lai"), "mill");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error(), "is of machine 'lai', not of 'mill'");
}

TEST(SetUpText, OfToolsThatAreCutShortIsRefused) {
  const std::string head = "meridian set-up 2\nmachine = lai\nactive = 0\nframes = 0\n";
  EXPECT_TRUE(parse_set_up(seal(head + "tools = 3\nabc\n"), "lai"));
  EXPECT_FALSE(parse_set_up(seal(head + "tools = 300\nabc\n"), "lai"));
  EXPECT_FALSE(parse_set_up(seal(head + "tools = abc\n"), "lai"));
}

TEST(SetUpText, OfLimitsThatAreNoneIsRefused) {
  const std::string head = "meridian set-up 3\nmachine = lai\nactive = 0\nframes = 0\n";
  EXPECT_TRUE(parse_set_up(seal(head + "limits = 0\n"), "lai"));
  const auto read = parse_set_up(seal(head + "limits = 1\nlimit = 2 -1.5 3\n"), "lai");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->limits.rows()[1], (SoftLimits::Row{true, -1.5, 3}));
  for (const char* rest : {"", "limits = 2\nlimit = 2 -1.5 3\n", "limits = 7\n", "limits = x\n",
                           "limits = 1\nlimit = 0 -1.5 3\n", "limits = 1\nlimit = 7 -1.5 3\n",
                           "limits = 1\nlimit = 2 -1.5\n", "limits = 1\nlimit = 2 -1.5 3 4\n"}) {
    EXPECT_FALSE(parse_set_up(seal(head + rest), "lai")) << rest;
  }
}

TEST(SetUpText, SaysOfLimitsWhatTheyAreAndWhatIsWrong) {
  MachineModel model;
  model.joint_count = 2;
  model.joints[0].name = "X";
  model.joints[0].limits.travel_min = -600;
  model.joints[0].limits.travel_max = 600;
  model.joints[1].name = "C";
  model.joints[1].is_rotary = model.joints[1].is_endless = true;
  SoftLimits limits;
  EXPECT_EQ(limits_text(limits, model), "no soft limits");
  limits.put(0, -40, 42.5);
  limits.put(1, 0, units::rad_from_deg(30));
  EXPECT_EQ(limits_text(limits, model), "soft limits X -40 to 42.5 mm, C 0 to 30 deg");
  SoftLimits tipped;
  tipped.put(TipBox{true, {-1, 0, 2.5}, {9, 8, 7}});
  EXPECT_EQ(limits_text(tipped, model), "tip box (X -1 to 9 mm, Y 0 to 8 mm, Z 2.5 to 7 mm)");
  model.tip_box = {true, {-1, 0, 2.5}, {9, 8, 7}};
  EXPECT_EQ(describe(LimitsFault::kTipBeyond, 0, model),
            "the machine file's tip box is -1,0,2.5 to 9,8,7 mm; give one that is inside of it");
  EXPECT_EQ(describe(LimitsFault::kTravel, 0, model),
            "X has a travel of -600 to 600 mm, which soft limits only shrink");
  EXPECT_EQ(describe(LimitsFault::kEndless, 1, model), "C is endless, it has no travel to shrink");
  EXPECT_EQ(describe(LimitsFault::kJoint, 4, model), "the machine has no joint number 5");
  EXPECT_NE(describe(LimitsFault::kValue, 0, model).find("swap"), std::string::npos);
}

TEST(SetUpText, ThatSelectsWhatItHasNotIsRefused) {
  const std::string head = "meridian set-up 1\nmachine = lai\n";
  EXPECT_TRUE(parse_set_up(seal(head + "active = 0\nframes = 0\n"), "lai"));
  EXPECT_FALSE(parse_set_up(seal(head + "active = 4\nframes = 0\n"), "lai"));
  EXPECT_FALSE(parse_set_up(seal(head + "active = 0\nframes = 1\n"), "lai"));
  EXPECT_FALSE(parse_set_up(seal(head + "active = 0\nframes = 99\n"), "lai"));
  EXPECT_FALSE(
      parse_set_up(seal(head + "active = 0\nframes = 1\nframe = 1 0 0 0 0 0 nan v\n"), "lai"));
}

TEST(SetUpText, SaysWhatToDoAboutEveryFault) {
  EXPECT_EQ(describe(FrameFault::kNotSet, 7), "frame 7 is not set; see meridian ctl frame list");
  EXPECT_EQ(describe(FrameFault::kIsActive, 7), "frame 7 is in force; select another one first");
  EXPECT_NE(describe(FrameFault::kNumber, 77).find("1 to 54"), std::string::npos);
  EXPECT_NE(describe(FrameFault::kValue, 7).find("mm within 100000"), std::string::npos);
}

}  // namespace
}  // namespace meridian::telemetry
