// SPDX-License-Identifier: Apache-2.0
#include "meridian/kinematics/work_frame.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

namespace meridian {
namespace {

WorkFrame frame_of(int number, double x_mm = 0, const char* name = "") {
  WorkFrame frame;
  frame.number = static_cast<std::uint8_t>(number);
  frame.origin_mm = {x_mm, 0, 0};
  std::strncpy(frame.name.data(), name, kFrameNameChars);
  return frame;
}

FrameFault set(WorkFrames& frames, const WorkFrame& frame) {
  return frames.apply({FrameWord::kSet, frame});
}

FrameFault say(WorkFrames& frames, FrameWord word, int number) {
  return frames.apply({word, frame_of(number)});
}

std::vector<int> numbers_of(const WorkFrames& frames) {
  std::vector<int> numbers;
  for (const WorkFrame& row : frames.rows()) numbers.push_back(row.number);
  return numbers;
}

TEST(WorkFrames, KeepTheirRowsInTheOrderOfNumbers) {
  WorkFrames frames;
  for (const int number : {7, 1, 54, 3}) {
    EXPECT_EQ(set(frames, frame_of(number, 10.0 * number)), FrameFault::kNone);
  }
  EXPECT_EQ(numbers_of(frames), (std::vector{1, 3, 7, 54}));
  for (const WorkFrame& row : frames.rows()) EXPECT_EQ(row.origin_mm[0], 10.0 * row.number);
  EXPECT_EQ(frames.active(), 0);
}

TEST(WorkFrames, ReplaceARowThatIsSetAgain) {
  WorkFrames frames;
  ASSERT_EQ(set(frames, frame_of(3, 1, "old")), FrameFault::kNone);
  ASSERT_EQ(set(frames, frame_of(3, 2, "new")), FrameFault::kNone);
  ASSERT_EQ(frames.rows().size(), 1U);
  EXPECT_EQ(*frames.find(3), frame_of(3, 2, "new"));
}

TEST(WorkFrames, HaveAPlaceForEveryNumberAndNoOther) {
  WorkFrames frames;
  for (int number = WorkFrames::kMax; number >= 1; --number) {
    ASSERT_EQ(set(frames, frame_of(number)), FrameFault::kNone);
  }
  EXPECT_EQ(frames.rows().size(), std::size_t{WorkFrames::kMax});
  const WorkFrames before = frames;
  EXPECT_EQ(set(frames, frame_of(0)), FrameFault::kNumber);
  EXPECT_EQ(set(frames, frame_of(WorkFrames::kMax + 1)), FrameFault::kNumber);
  EXPECT_EQ(frames, before);
}

TEST(WorkFrames, RefuseWhatIsNoPlace) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {kNan, 1.1e5, -1.1e5, std::numeric_limits<double>::infinity()}) {
    WorkFrames frames;
    EXPECT_EQ(set(frames, frame_of(1, bad)), FrameFault::kValue);
    WorkFrame turned = frame_of(1);
    turned.rotation_deg[2] = bad;
    EXPECT_EQ(set(frames, turned), FrameFault::kValue);
    EXPECT_TRUE(frames.rows().empty());
  }
}

TEST(WorkFrames, SelectOnlyWhatIsSetOrTheMachineFiles) {
  WorkFrames frames;
  EXPECT_EQ(say(frames, FrameWord::kSelect, 2), FrameFault::kNotSet);
  ASSERT_EQ(set(frames, frame_of(2)), FrameFault::kNone);
  EXPECT_EQ(say(frames, FrameWord::kSelect, 2), FrameFault::kNone);
  EXPECT_EQ(frames.active(), 2);
  EXPECT_EQ(say(frames, FrameWord::kSelect, 0), FrameFault::kNone);
  EXPECT_EQ(frames.active(), 0);
}

TEST(WorkFrames, ClearARowButNotTheActiveOne) {
  WorkFrames frames;
  for (const int number : {1, 2, 3}) ASSERT_EQ(set(frames, frame_of(number)), FrameFault::kNone);
  ASSERT_EQ(say(frames, FrameWord::kSelect, 2), FrameFault::kNone);
  EXPECT_EQ(say(frames, FrameWord::kClear, 2), FrameFault::kIsActive);
  EXPECT_EQ(say(frames, FrameWord::kClear, 9), FrameFault::kNotSet);
  EXPECT_EQ(say(frames, FrameWord::kClear, 1), FrameFault::kNone);
  EXPECT_EQ(numbers_of(frames), (std::vector{2, 3}));
  EXPECT_EQ(frames.active(), 2);
}

TEST(WorkFrames, KnowNoOtherWord) {
  WorkFrames frames;
  EXPECT_EQ(frames.apply({static_cast<FrameWord>(3), frame_of(1)}), FrameFault::kWord);
}

}  // namespace
}  // namespace meridian
