// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/feedback_merge.hpp"

#include <gtest/gtest.h>

#include "unit/daemon/feedback_sample.hpp"

namespace meridian::interpolator {
namespace {

using test::kMilli;
using test::sample;

constexpr std::uint16_t kFault = 0x08;

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
  for (std::uint64_t n = 1; n <= 300; ++n) {
    EXPECT_TRUE(merge.take(sample(1, 0b1, n), 9,
                           50 * kMilli + static_cast<std::int64_t>(n) * kMilli, true));
    ASSERT_EQ(merge.feedback().contested_mask, 0U) << "the dead one says nothing any more";
  }
  EXPECT_EQ(merge.feedback().cycle_seen, 400U);
  EXPECT_EQ(merge.feedback().arrival_ns, 350 * kMilli);
}

TEST(FeedbackMerge, SaysWhichJointsObeyAnotherService) {
  constexpr std::uint64_t kOurs = 70, kTheirs = 71, kNobody = 0;
  FeedbackMerge merge(0b11111, kOurs);
  const auto report = [&merge](std::uint64_t number, std::uint32_t group, std::uint32_t mask,
                               std::uint64_t service) {
    dds::DriveFeedback feedback = sample(group, mask, number);
    feedback.service_id = service;
    ASSERT_TRUE(merge.take(feedback, group, static_cast<std::int64_t>(number) * kMilli));
  };
  report(1, 1, 0b00111, kOurs);
  report(1, 2, 0b11000, kTheirs);
  EXPECT_EQ(merge.feedback().foreign_mask, 0b11000U);
  EXPECT_EQ(master_of(merge.sources(), kOurs, kMilli), kOurs) << "some obey us";
  EXPECT_EQ(master_of(merge.sources(), 72, kMilli), 0U) << "they do not agree";
  report(2, 1, 0b00111, kTheirs);
  EXPECT_EQ(merge.feedback().foreign_mask, 0b11111U);
  EXPECT_EQ(master_of(merge.sources(), kOurs, kMilli), kTheirs);
  EXPECT_EQ(master_of(merge.sources(), kOurs, 5000 * kMilli), 0U) << "nobody has said it of late";
  report(3, 1, 0b00111, kNobody);
  report(3, 2, 0b11000, kNobody);
  EXPECT_EQ(merge.feedback().foreign_mask, 0U);
}

TEST(FeedbackMerge, AFloodOfGroupsTakesNoDriveAndNoMoreRoom) {
  FeedbackMerge merge;
  ASSERT_TRUE(merge.take(sample(1, 0b11111, 1), 7, kMilli));
  for (std::uint32_t group = 2; group < 10'000; ++group) {
    (void)merge.take(sample(group, 0b11111, 1), 8, 2 * kMilli);
  }
  EXPECT_TRUE(merge.sources().is_full);
  EXPECT_EQ(merge.feedback().position[0], 10.0);
  EXPECT_TRUE(merge.take(sample(1, 0b11111, 2), 7, 3 * kMilli));
  EXPECT_EQ(merge.feedback().cycle_seen, 102U);
}

TEST(FeedbackMerge, ASilentFloodOfGroupsShutsNoDriveOut) {
  FeedbackMerge merge;
  for (std::uint32_t group = 2; group < 100; ++group) {
    (void)merge.take(sample(group, 0b11111, 1), 8, kMilli);
  }
  ASSERT_TRUE(merge.sources().is_full);
  const bool is_off = true;
  ASSERT_TRUE(merge.take(sample(1, 0b11111, 1), 7, 300 * kMilli, is_off));
  EXPECT_EQ(merge.feedback().joint_mask, 0b11111U);
  EXPECT_EQ(merge.feedback().position[0], 10.0) << "its writer lives, but says nothing any more";
}

TEST(FeedbackMerge, KeepsAnOpenStopInputInAFlood) {
  FeedbackMerge merge;
  dds::DriveFeedback open = sample(1, 0b1, 1);
  open.is_emergency_stop = true;
  ASSERT_TRUE(merge.take(sample(1, 0b1, 1), 7, kMilli));
  ASSERT_TRUE(merge.take(open, 9, kMilli));
  for (std::uint32_t group = 2; group < 100; ++group) {
    (void)merge.take(sample(group, 0b11110, 1), 8, kMilli + group * 300 * kMilli);
  }
  EXPECT_TRUE(merge.feedback().emergency_stop);
}

TEST(FeedbackMerge, KnowsOfEachJointWhenItsOwnGroupReported) {
  FeedbackMerge merge;
  ASSERT_TRUE(merge.take(sample(1, 0b00111, 1), 7, kMilli));
  ASSERT_TRUE(merge.take(sample(2, 0b11000, 4), 8, 2 * kMilli));
  EXPECT_EQ(merge.feedback().joint_arrival_ns[2], kMilli);
  EXPECT_EQ(merge.feedback().joint_arrival_ns[3], 2 * kMilli);
  EXPECT_EQ(merge.feedback().joint_cycle_seen[2], 101U);
  EXPECT_EQ(merge.feedback().joint_cycle_seen[3], 104U);
}

TEST(FeedbackMerge, IsInContactAsSoonAsOneSourceSaysSo) {
  FeedbackMerge merge;
  dds::DriveFeedback own = sample(1, 0b11111, 1), box = sample(2, 0, 1);
  ASSERT_TRUE(merge.take(own, 7, kMilli));
  EXPECT_EQ(merge.feedback().probe, ProbeInput::kNone);
  own.sample = 2;
  own.probe = ProbeInput::kFree;
  box.probe = ProbeInput::kContact;
  ASSERT_TRUE(merge.take(own, 7, 2 * kMilli));
  EXPECT_EQ(merge.feedback().probe, ProbeInput::kFree);
  ASSERT_TRUE(merge.take(box, 8, 2 * kMilli));
  EXPECT_EQ(merge.feedback().probe, ProbeInput::kContact) << "an input without drives";
  EXPECT_EQ(merge.words().probe, ProbeInput::kContact);
  box.sample = 2;
  box.probe = static_cast<ProbeInput>(200);
  ASSERT_TRUE(merge.take(box, 8, 3 * kMilli));
  EXPECT_EQ(merge.feedback().probe, ProbeInput::kFree) << "no probe says so";
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

/// Two sources of the same drives, both every millisecond, `other` behind `own` in each.
struct TwoSources {
  void run(int periods, bool may_hand_over, bool is_own_alive = true, bool is_other_alive = true) {
    for (int n = 0; n < periods; ++n) {
      now_ns += kMilli;
      ++number;
      if (is_own_alive) (void)merge.take(said_by_own(), 7, now_ns, may_hand_over);
      if (is_other_alive) (void)merge.take(said_by_other(), 8, now_ns + 1, may_hand_over);
    }
  }
  [[nodiscard]] dds::DriveFeedback said_by_own() const {
    dds::DriveFeedback said = sample(0, 0b11111, number);
    said.is_emergency_stop = is_own_stopped;
    said.position[0] = 1;
    return said;
  }
  [[nodiscard]] dds::DriveFeedback said_by_other() const {
    dds::DriveFeedback said = sample(others_group, others_mask, number);
    said.is_emergency_stop = is_other_stopped;
    said.position[0] = 2;
    said.statusword[0] = kFault;
    return said;
  }

  FeedbackMerge merge{0b11111};
  std::uint32_t others_group = 0, others_mask = 0b11111;
  std::uint64_t number = 0;
  std::int64_t now_ns = kMilli;
  bool is_own_stopped = false, is_other_stopped = false;
};

TEST(FeedbackMerge, GoesByTheSourceThatReportedADriveFirstAndSaysThatASecondOneDoes) {
  for (const std::uint32_t group : {0U, 1U}) {
    for (const bool is_off : {false, true}) {
      TwoSources two;
      two.others_group = group;
      two.run(10, is_off, true, false);
      EXPECT_EQ(two.merge.feedback().contested_mask, 0U);
      two.run(10, is_off);
      EXPECT_EQ(two.merge.feedback().position[0], 1) << group << is_off;
      EXPECT_EQ(two.merge.feedback().fault_mask, 0U);
      EXPECT_EQ(two.merge.feedback().contested_mask, 0b11111U);
      EXPECT_EQ(two.merge.feedback().joint_mask, 0b11111U);
      two.run(300, is_off, true, false);
      EXPECT_EQ(two.merge.feedback().contested_mask, 0U) << "it is gone";
    }
  }
}

TEST(FeedbackMerge, CountsTheStopInputOfEverySourceWhateverElseIsTakenFromIt) {
  for (const std::uint32_t group : {0U, 1U}) {
    for (const std::uint32_t mask : {0b11111U, 0b100000U, 0U}) {  // another machine's; none
      TwoSources two;
      two.others_group = group;
      two.others_mask = mask;
      two.is_own_stopped = true;
      two.run(3, true);
      EXPECT_TRUE(two.merge.feedback().emergency_stop) << "behind the other one's word";
      two.is_own_stopped = false;
      two.is_other_stopped = true;
      two.run(3, true);
      EXPECT_TRUE(two.merge.feedback().emergency_stop) << group << " " << mask;
      two.run(3000, true, true, false);
      EXPECT_TRUE(two.merge.feedback().emergency_stop) << "it may hang with its input open";
      two.merge.forget(8, two.now_ns, true);
      EXPECT_FALSE(two.merge.feedback().emergency_stop) << "it is gone";
    }
  }
}

TEST(FeedbackMerge, HandsADriveOverFromADeadSourceWhereTheMachineIsOff) {
  TwoSources two;
  two.run(10, false);
  two.run(300, false, false);
  EXPECT_EQ(two.merge.feedback().position[0], 1) << "it runs";
  EXPECT_EQ(two.merge.feedback().arrival_ns, two.now_ns - 300 * kMilli) << "and misses them";
  two.run(1, true, false);
  EXPECT_EQ(two.merge.feedback().position[0], 2);
  EXPECT_EQ(two.merge.feedback().arrival_ns, two.now_ns + 1);
  two.run(10, true);
  EXPECT_EQ(two.merge.feedback().position[0], 2) << "the first came back, and comes too late";
  EXPECT_EQ(two.merge.feedback().contested_mask, 0b11111U);
}

TEST(FeedbackMerge, ForgetsAGroupWhoseWriterIsGone) {
  FeedbackMerge merge(0b11111);
  ASSERT_TRUE(merge.take(sample(1, 0b00111, 1), 7, 1000));
  ASSERT_TRUE(merge.take(sample(2, 0b11000, 1), 8, 1000));
  merge.forget(8, 2000, false);
  EXPECT_EQ(merge.feedback().joint_mask, 0b11111U) << "it runs, and misses them";
  merge.forget(8, 2000, true);
  EXPECT_EQ(merge.feedback().joint_mask, 0b00111U);
  merge.forget(7, 2000, true);
  EXPECT_EQ(merge.feedback().joint_mask, 0U);
  EXPECT_EQ(merge.feedback().arrival_ns, 0) << "as if nobody had been there";
}

TEST(FeedbackMerge, DoesNotMissAGroupOfDrivesThatTheMachineHasNot) {
  FeedbackMerge merge(0b11111);
  ASSERT_TRUE(merge.take(sample(2, 0b100000, 1), 8, 1000));
  ASSERT_TRUE(merge.take(sample(1, 0b11111, 1), 7, 9000));
  EXPECT_EQ(merge.feedback().arrival_ns, 9000);
  EXPECT_EQ(merge.feedback().joint_mask, 0b11111U);
  EXPECT_EQ(merge.feedback().cycle_seen, 101U);
  EXPECT_EQ(merge.feedback().contested_mask, 0U);
}

TEST(FeedbackMerge, MissesAStopInputThatFallsSilent) {
  FeedbackMerge merge(0b11111);
  ASSERT_TRUE(merge.take(sample(9, 0, 1), 8, 1000));
  ASSERT_TRUE(merge.take(sample(1, 0b11111, 1), 7, 9000));
  EXPECT_EQ(merge.feedback().arrival_ns, 1000);
  EXPECT_EQ(merge.feedback().oldest_joint, kNoJoint);
  EXPECT_EQ(merge.feedback().cycle_seen, 101U) << "it takes no setpoints";
}

TEST(FeedbackMerge, NamesTheLowestJointOfTheGroupThatIsSilentOrDeaf) {
  FeedbackMerge merge;
  ASSERT_TRUE(merge.take(sample(2, 0b11000, 1), 8, 1000));
  dds::DriveFeedback deaf = sample(1, 0b00110, 1);
  deaf.cycle_seen = 50;
  ASSERT_TRUE(merge.take(deaf, 7, 9000));
  EXPECT_EQ(merge.feedback().oldest_joint, 3);
  EXPECT_EQ(merge.feedback().deafest_joint, 1);
  EXPECT_EQ(merge.words().oldest_group, 2U);
  EXPECT_EQ(merge.words().oldest_mask, 0b11000U);
}

TEST(FeedbackMerge, KnowsWhenAnOpenStopInputWasReportedLastWhateverOthersReport) {
  FeedbackMerge merge;
  dds::DriveFeedback open = sample(1, 0b01, 1);
  open.is_emergency_stop = true;
  ASSERT_TRUE(merge.take(open, 7, 1000));
  ASSERT_TRUE(merge.take(sample(2, 0b10, 1), 8, 5000));
  EXPECT_TRUE(merge.feedback().emergency_stop) << "its bridge is silent since";
  EXPECT_EQ(merge.feedback().emergency_ns, 1000);
  open.sample = 2;
  ASSERT_TRUE(merge.take(open, 7, 6000));
  EXPECT_EQ(merge.feedback().emergency_ns, 6000);
  dds::DriveFeedback late = sample(2, 0b10, 2);
  late.is_emergency_stop = true;
  ASSERT_TRUE(merge.take(late, 8, 7000));
  ASSERT_TRUE(merge.take(sample(1, 0b01, 3), 7, 8000));
  EXPECT_EQ(merge.feedback().emergency_ns, 7000) << "of those that say so, the newest";
  ASSERT_TRUE(merge.take(sample(2, 0b10, 3), 8, 9000));
  EXPECT_FALSE(merge.feedback().emergency_stop);
  EXPECT_EQ(merge.feedback().emergency_ns, 0);
}

TEST(FeedbackMerge, HoldsAJointForTheGroupThatLeavesItOut) {
  FeedbackMerge merge;
  ASSERT_TRUE(merge.take(sample(1, 0b11, 1), 7, 1000));
  ASSERT_TRUE(merge.take(sample(1, 0b01, 2), 7, 2000));
  EXPECT_EQ(merge.feedback().joint_mask, 0b01U);
  ASSERT_TRUE(merge.take(sample(2, 0b10, 1), 8, 2000));
  EXPECT_EQ(merge.feedback().joint_mask, 0b01U) << "it runs";
  ASSERT_TRUE(merge.take(sample(2, 0b10, 2), 8, 3000, true));
  EXPECT_EQ(merge.feedback().joint_mask, 0b11U);
  EXPECT_EQ(merge.feedback().position[1], 21);
}

TEST(FeedbackMerge, CountsTheStopInputOfWhoFindsNoPlace) {
  FeedbackMerge merge;
  for (std::uint64_t writer = 1; writer <= merge.sources().slots.size(); ++writer) {
    ASSERT_TRUE(merge.take(sample(1, 0b1, 1), writer, 1000));
  }
  dds::DriveFeedback open = sample(1, 0, 1);
  open.is_emergency_stop = true;
  (void)merge.take(open, 99, 2000);
  EXPECT_TRUE(merge.feedback().emergency_stop);
  EXPECT_TRUE(merge.sources().is_full);
  ASSERT_TRUE(merge.take(sample(1, 0b1, 2), 1, 300 * kMilli));
  EXPECT_FALSE(merge.feedback().emergency_stop) << "it said nothing since";
  merge.forget(2, 300 * kMilli, false);
  EXPECT_FALSE(merge.sources().is_full);
}

}  // namespace
}  // namespace meridian::interpolator
