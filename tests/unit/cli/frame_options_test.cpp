// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/frame_options.hpp"

#include <gtest/gtest.h>

namespace meridian::cli {
namespace {

TEST(FrameOptions, MakeAnOrderOfWords) {
  const auto set = frame_order({"set", "3"}, {"-10,0.5,120,0,0,90", "vice"});
  ASSERT_TRUE(set);
  EXPECT_EQ(set->word, FrameWord::kSet);
  EXPECT_EQ(set->frame.number, 3);
  EXPECT_STREQ(set->frame.name.data(), "vice");
  EXPECT_EQ(set->frame.origin_mm, (Array3{-10, 0.5, 120}));
  EXPECT_EQ(set->frame.rotation_deg, (Array3{0, 0, 90}));
  EXPECT_EQ(frame_order({"select", "0"}, {})->word, FrameWord::kSelect);
  EXPECT_EQ(frame_order({"clear", "7"}, {})->frame.number, 7);
}

TEST(FrameOptions, RefuseWhatIsNone) {
  const FrameOptions at{"1,2,3", ""};
  EXPECT_FALSE(frame_order({}, {}));
  EXPECT_FALSE(frame_order({"move", "3"}, at));
  EXPECT_FALSE(frame_order({"set"}, at));
  EXPECT_FALSE(frame_order({"set", "3", "4"}, at));
  for (const char* number : {"x", "", "-1", "300", "1.5"}) {
    EXPECT_FALSE(frame_order({"set", number}, at)) << number;
  }
  EXPECT_FALSE(frame_order({"set", "3"}, {}));
  EXPECT_FALSE(frame_order({"set", "3"}, {"1,2", ""}));
  EXPECT_FALSE(frame_order({"set", "3"}, {"1,2,3", std::string(24, 'x')}));
  EXPECT_FALSE(frame_order({"select", "3"}, at));
}

TEST(FrameOptions, ListTheSetUpWithAMarkAtTheOneInForce) {
  dds::MachineInfo machine;
  machine.work_frame = 12;
  const auto row = frame_order({"set", "12"}, {"10,0,120.125,0,0,-90", "left vice"});
  machine.work_frames = {frame_order({"set", "2"}, {"1,2,3", ""})->frame, row->frame};
  EXPECT_EQ(frames_text(machine),
            "   0  machine file\n"
            "   2  --at 1,2,3,0,0,0  \n"
            "* 12  --at 10,0,120.125,0,0,-90  left vice\n");
}

}  // namespace
}  // namespace meridian::cli
