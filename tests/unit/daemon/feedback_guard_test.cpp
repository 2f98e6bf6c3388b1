// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "service/daemon/listeners/feedback_merge.hpp"
#include "unit/daemon/feedback_sample.hpp"

/// The guard of the work space, of whomever reports it.
namespace meridian::interpolator {
namespace {

using test::kMilli;
using test::sample;

TEST(GuardOfFeedback, HasAnOpenGuardAsLongAsOneSourceSaysSo) {
  FeedbackMerge merge;
  dds::DriveFeedback own = sample(1, 0b11111, 1), box = sample(2, 0, 1);
  ASSERT_TRUE(merge.take(own, 7, kMilli));
  EXPECT_FALSE(merge.feedback().is_guard_open) << "where nobody says so it is shut";
  box.is_guard_open = true;
  ASSERT_TRUE(merge.take(box, 8, kMilli));
  own.sample = 2;
  ASSERT_TRUE(merge.take(own, 7, 2 * kMilli));
  EXPECT_TRUE(merge.feedback().is_guard_open) << "an input without drives";
  EXPECT_FALSE(merge.feedback().emergency_stop);
  box.sample = 2;
  box.is_guard_open = false;
  ASSERT_TRUE(merge.take(box, 8, 3 * kMilli));
  EXPECT_FALSE(merge.feedback().is_guard_open);
}

/// A source that said at 1 ms that its guard is open, beside the drives of the machine.
struct GuardBeside {
  GuardBeside(std::uint32_t group, std::uint32_t mask) : box(sample(group, mask, 1)) {
    box.is_guard_open = true;
    (void)merge.take(own, 7, kMilli);
    (void)merge.take(box, 8, kMilli);
  }
  /// What the drives report `at_ms`.
  bool is_open_at(std::int64_t at_ms) {
    own.sample += 1;
    (void)merge.take(own, 7, at_ms * kMilli);
    return merge.feedback().is_guard_open;
  }
  void shut(std::int64_t at_ms) {
    box.is_guard_open = false;
    box.sample += 1;
    (void)merge.take(box, 8, at_ms * kMilli);
  }
  FeedbackMerge merge{0b11111};
  dds::DriveFeedback own = sample(1, 0b11111, 1), box;
};

TEST(GuardOfFeedback, HearsAGuardOfWhomeverTakesPartInNothingElse) {
  EXPECT_TRUE(GuardBeside(2, 0b100000).is_open_at(2)) << "with a joint that is none of ours";
  EXPECT_TRUE(GuardBeside(2, 0b00001).is_open_at(2)) << "with a joint that another one reports";
  EXPECT_TRUE(GuardBeside(2, 0).is_open_at(2));
}

TEST(GuardOfFeedback, HearsAGuardInAFlood) {
  FeedbackMerge merge(0b11111);
  ASSERT_TRUE(merge.take(sample(1, 0b11111, 1), 7, kMilli));
  for (std::uint32_t group = 2; group < 100; ++group) {
    (void)merge.take(sample(group, 0b11111, 1), 8, 2 * kMilli);
  }
  dds::DriveFeedback box = sample(200, 0, 1);
  box.is_guard_open = true;
  (void)merge.take(box, 9, 3 * kMilli);
  EXPECT_TRUE(merge.feedback().is_guard_open);
}

TEST(GuardOfFeedback, TakesTheSilenceOfAGuardForAnOpenOne) {
  GuardBeside guard(2, 0);
  guard.shut(10);
  EXPECT_FALSE(guard.is_open_at(200)) << "it spoke 190 ms ago";
  EXPECT_TRUE(guard.is_open_at(300)) << "its cable is cut";
  guard.shut(310);
  EXPECT_FALSE(guard.is_open_at(320)) << "it speaks again";
}

TEST(GuardOfFeedback, IsNotShutByDrivesOfTheSameGroupThatSpokeAllTheWhile) {
  for (const std::uint32_t mask : {0U, 0b100000U}) {
    GuardBeside guard(1, mask);
    EXPECT_TRUE(guard.is_open_at(150));
    EXPECT_TRUE(guard.is_open_at(300)) << mask << ": its cable is cut while it is open";
    EXPECT_TRUE(guard.is_open_at(9000)) << mask;
    guard.merge.forget(8, 9001 * kMilli, true);
    EXPECT_TRUE(guard.is_open_at(9002)) << mask << ": its program is gone";
  }
}

TEST(GuardOfFeedback, LeavesRoomForDrivesHoweverManyGuardsAreGone) {
  FeedbackMerge merge(0b11111);
  for (std::uint32_t group = 2; group < 40; ++group) {
    dds::DriveFeedback box = sample(group, 0, 1);
    box.is_guard_open = true;
    const std::int64_t now_ns = static_cast<std::int64_t>(group) * 300 * kMilli;
    (void)merge.take(box, 8, now_ns);
    merge.forget(8, now_ns + kMilli, true);
  }
  ASSERT_TRUE(merge.take(sample(1, 0b11111, 1), 7, 20'000 * kMilli, true));
  EXPECT_EQ(merge.feedback().joint_mask, 0b11111U);
  EXPECT_TRUE(merge.feedback().is_guard_open);
}

TEST(GuardOfFeedback, KeepsAGuardOpenWhoseWriterIsGone) {
  for (const bool is_off : {false, true}) {
    GuardBeside guard(2, 0);
    guard.shut(10);
    guard.merge.forget(8, 300 * kMilli, is_off);
    EXPECT_TRUE(guard.is_open_at(301)) << is_off;
    EXPECT_TRUE(guard.is_open_at(9000)) << is_off;
    dds::DriveFeedback again = sample(2, 0, 1);
    (void)guard.merge.take(again, 9, 9001 * kMilli);
    EXPECT_FALSE(guard.is_open_at(9002)) << "it was started anew and says that it is shut";
    EXPECT_TRUE(guard.is_open_at(9500)) << "it has a guard all the same";
  }
}

TEST(GuardOfFeedback, LeavesTheDrivesOfAGuardThatIsGoneToWhomComes) {
  FeedbackMerge merge(0b11111);
  dds::DriveFeedback own = sample(1, 0b11111, 1);
  own.is_guard_open = true;
  ASSERT_TRUE(merge.take(own, 7, kMilli));
  merge.forget(7, 300 * kMilli, true);
  EXPECT_EQ(merge.feedback().joint_mask, 0U);
  ASSERT_TRUE(merge.take(sample(1, 0b11111, 1), 9, 400 * kMilli, true));
  EXPECT_EQ(merge.feedback().joint_mask, 0b11111U);
  EXPECT_EQ(merge.feedback().arrival_ns, 400 * kMilli);
  EXPECT_FALSE(merge.feedback().is_guard_open);
}

}  // namespace
}  // namespace meridian::interpolator
