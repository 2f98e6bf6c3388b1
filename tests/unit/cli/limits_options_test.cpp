// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/operator/limits_options.hpp"

#include <gtest/gtest.h>

#include "meridian/units.hpp"

namespace meridian::cli {
namespace {

dds::MachineInfo machine() {
  dds::MachineInfo info;
  info.name = "mill";
  info.joint_count = 3;
  info.joints[0].name = "X";
  info.joints[0].limits = {.travel_min = -700, .travel_max = 700};
  info.joints[1].name = "A";
  info.joints[1].is_rotary = true;
  info.joints[1].limits = {.travel_min = units::rad_from_deg(-110),
                           .travel_max = units::rad_from_deg(30)};
  info.joints[2].name = "C";
  info.joints[2].is_rotary = info.joints[2].is_endless = true;
  return info;
}

TEST(LimitsOptions, MakeAnOrderOfWords) {
  const auto x = limits_order({"set", "X", "-12.5", "200"}, machine());
  ASSERT_TRUE(x);
  EXPECT_EQ(*x, (LimitsOrder{LimitsWord::kSet, 0, -12.5, 200}));
  const auto a = limits_order({"set", "A", "-90", "0"}, machine());
  ASSERT_TRUE(a);
  EXPECT_EQ(a->min, -90 * units::kDegree_rad) << "as a machine file has it";
  EXPECT_EQ(limits_order({"clear", "A"}, machine()), (LimitsOrder{LimitsWord::kClear, 1, 0, 0}));
  EXPECT_EQ(limits_order({"clear"}, machine())->joint, LimitsOrder::kAllJoints);
}

TEST(LimitsOptions, MakeAnOrderOfABox) {
  const auto vice =
      limits_order({"keep-out", "vice", "X", "-12.5", "200", "A", "-90", "0"}, machine());
  ASSERT_TRUE(vice);
  EXPECT_EQ(vice->word, LimitsWord::kKeepOut);
  EXPECT_STREQ(vice->box.name.data(), "vice");
  EXPECT_EQ(vice->box.joints, 0b11U);
  EXPECT_EQ(vice->box.max[0], 200);
  EXPECT_EQ(vice->box.min[1], -90 * units::kDegree_rad);
  EXPECT_STREQ(limits_order({"open", "vice"}, machine())->box.name.data(), "vice");
  EXPECT_EQ(limits_order({"open"}, machine())->word, LimitsWord::kOpen);
}

TEST(LimitsOptions, MakeAnOrderOfATipBox) {
  const auto tip = limits_order({"tip", "-10,0,2.5", "100,200,300"}, machine());
  ASSERT_TRUE(tip);
  EXPECT_EQ(tip->word, LimitsWord::kTip);
  EXPECT_EQ(tip->tip_box(), (TipBox{true, {-10, 0, 2.5}, {100, 200, 300}}));
  EXPECT_EQ(limits_order({"clear", "tip"}, machine())->word, LimitsWord::kClearTip);
}

TEST(LimitsOptions, RefuseWhatIsNone) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{},
                                                {"set"},
                                                {"set", "X", "1"},
                                                {"set", "X", "1", "2", "3"},
                                                {"set", "U", "1", "2"},
                                                {"set", "X", "a", "2"},
                                                {"set", "X", "1", "2mm"},
                                                {"set", "X", "nan", "2"},
                                                {"clear", "U"},
                                                {"clear", "X", "A"},
                                                {"keep-out", "vice"},
                                                {"keep-out", "vice", "X", "1"},
                                                {"keep-out", "vice", "U", "1", "2"},
                                                {"keep-out", "vice", "X", "1", "2", "X", "1", "2"},
                                                {"keep-out", std::string(24, 'x'), "X", "1", "2"},
                                                {"open", "vice", "probe"},
                                                {"tip", "0,0,0"},
                                                {"tip", "0,0,0", "1,1"},
                                                {"tip", "0,0,0", "1,1,1,1"},
                                                {"tip", "0,0,nan", "1,1,1"},
                                                {"move", "X", "1", "2"}}) {
    EXPECT_FALSE(limits_order(words, machine())) << testing::PrintToString(words);
  }
}

TEST(LimitsOptions, AreListedAsSetTakesThem) {
  dds::MachineInfo info = machine();
  info.soft_limits.put(0, -12.5, 200);
  EXPECT_EQ(limits_text(info),
            "*  X        -12.5 200 mm, of -700 700\n"
            "   A        -110 30 deg\n"
            "   C        endless\n");
  info.soft_limits.put(
      limits_order({"keep-out", "vice", "X", "1", "2", "A", "-9", "0"}, machine())->box);
  EXPECT_NE(limits_text(info).find("*  keep-out vice X 1 2 A -9 0\n"), std::string::npos);
  info.soft_limits.put(TipBox{true, {-1, 0, 2.5}, {9, 8, 7}});
  EXPECT_NE(limits_text(info).find("*  tip      -1,0,2.5 9,8,7 mm\n"), std::string::npos);
}

}  // namespace
}  // namespace meridian::cli
