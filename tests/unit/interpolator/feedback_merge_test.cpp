// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/feedback_merge.hpp"

#include <gtest/gtest.h>

namespace meridian::interpolator {
namespace {

constexpr std::uint16_t kEnabled = 0x27, kFault = 0x08;

dds::DriveFeedback sample(std::uint32_t group, std::uint32_t mask, std::uint64_t number) {
  dds::DriveFeedback feedback;
  feedback.drive_group = group;
  feedback.joint_mask = mask;
  feedback.sample = number;
  feedback.cycle_seen = 100 + number;
  for (std::size_t i = 0; i < kMaxJoints; ++i) {
    feedback.position[i] = 10.0 * group + static_cast<double>(i);
    feedback.statusword[i] = kEnabled;
  }
  return feedback;
}

TEST(FeedbackMerge, JoinsGroupsAndIsAsOldAsTheOldest) {
  FeedbackMerge merge;
  ASSERT_TRUE(merge.take(sample(1, 0b00111, 1), 7, 1000));
  ASSERT_TRUE(merge.take(sample(2, 0b11000, 4), 8, 2000));
  const Feedback& all = merge.feedback();
  EXPECT_EQ(all.joint_mask, 0b11111U);
  EXPECT_EQ(all.enabled_mask, 0b11111U);
  EXPECT_EQ(all.arrival_ns, 1000);
  EXPECT_EQ(all.cycle_seen, 101U);
  EXPECT_EQ(all.position[2], 12.0);
  EXPECT_EQ(all.position[3], 23.0);
}

TEST(FeedbackMerge, NeverTakesALateOrRepeatedSampleForFresh) {
  FeedbackMerge merge;
  ASSERT_TRUE(merge.take(sample(1, 0b1, 5), 7, 1000));
  EXPECT_FALSE(merge.take(sample(1, 0b1, 5), 7, 2000));
  EXPECT_FALSE(merge.take(sample(1, 0b1, 4), 7, 2000));
  EXPECT_EQ(merge.feedback().arrival_ns, 1000);
  EXPECT_TRUE(merge.take(sample(1, 0b1, 6), 7, 3000));
}

TEST(FeedbackMerge, StartsAnewWithADriveProcessThatWasRestarted) {
  FeedbackMerge merge;
  ASSERT_TRUE(merge.take(sample(1, 0b1, 5000), 7, 1000));
  EXPECT_TRUE(merge.take(sample(1, 0b1, 1), 9, 2000));
  EXPECT_EQ(merge.feedback().cycle_seen, 101U);
}

TEST(FeedbackMerge, ReadsHomingOfDrivesInHomingModeAlone) {
  FeedbackMerge merge;
  dds::DriveFeedback feedback = sample(1, 0b111, 1);
  feedback.statusword = {0x1627, 0x1627, 0x2627, 0, 0, 0};
  feedback.mode_display = {dds::kCyclicPositionMode, dds::kHomingMode, dds::kHomingMode, 0, 0, 0};
  ASSERT_TRUE(merge.take(feedback, 7, 1000));
  EXPECT_EQ(merge.feedback().homing_mask, 0b110U);
  EXPECT_EQ(merge.feedback().homed_mask, 0b010U) << "bit 12 means something else in mode 8";
  EXPECT_EQ(merge.feedback().homing_error_mask, 0b100U);
  EXPECT_EQ(merge.feedback().still_mask, 0b110U);
}

TEST(FeedbackMerge, RefusesAbsurdMasks) {
  FeedbackMerge merge;
  EXPECT_FALSE(merge.take(sample(1, 0, 1), 7, 1000));
  EXPECT_FALSE(merge.take(sample(1, 1U << kMaxJoints, 1), 7, 1000));
  EXPECT_EQ(merge.feedback().arrival_ns, 0);
}

TEST(FeedbackMerge, ReportsFaultsReferencesAndTheStopInputByJoint) {
  FeedbackMerge merge;
  dds::DriveFeedback bad = sample(1, 0b11, 1);
  bad.statusword[1] = kFault;
  bad.referenced_mask = 0b101;
  bad.is_emergency_stop = true;
  ASSERT_TRUE(merge.take(bad, 7, 1000));
  EXPECT_EQ(merge.feedback().enabled_mask, 0b01U);
  EXPECT_EQ(merge.feedback().fault_mask, 0b10U);
  EXPECT_EQ(merge.feedback().referenced_mask, 0b01U);
  EXPECT_TRUE(merge.feedback().emergency_stop);
  EXPECT_EQ(merge.words().fault_mask, 0b10U);
}

TEST(FeedbackMerge, HandsAJointOverToTheGroupThatClaimsItLast) {
  FeedbackMerge merge;
  ASSERT_TRUE(merge.take(sample(1, 0b11, 1), 7, 1000));
  ASSERT_TRUE(merge.take(sample(2, 0b11, 1), 8, 2000));
  EXPECT_EQ(merge.feedback().arrival_ns, 2000) << "group 1 has no joint left to be old for";
}

}  // namespace
}  // namespace meridian::interpolator
