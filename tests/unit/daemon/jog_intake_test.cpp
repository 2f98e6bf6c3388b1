// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/jog_intake.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace meridian::interpolator {
namespace {

constexpr std::uint16_t kEpoch = 3;
constexpr std::uint64_t kService = 99, kParticipant = 4711;
constexpr int kJoints = 5;
constexpr double kTool_mm = 110;

dds::Jog jog_of(std::uint64_t operator_id, std::uint64_t sample) {
  return {.operator_id = operator_id,
          .sample = sample,
          .epoch_seen = kEpoch,
          .joint = 2,
          .velocity = 10,
          .distance = 0,
          .dead_man_ns = 100'000'000};
}

TEST(JogIntake, TakesWhatTheOperatorWhoJogsSays) {
  JogIntake intake(kService);
  EXPECT_FALSE(intake.take(jog_of(7, 1), kParticipant, kEpoch, kJoints, kTool_mm, 0))
      << "nobody jogs";
  intake.begin(7, kParticipant, 31);
  const auto order = intake.take(jog_of(7, 1), kParticipant, kEpoch, kJoints, kTool_mm, 0);
  ASSERT_TRUE(order);
  EXPECT_EQ(order->joint, 2);
  EXPECT_EQ(order->velocity, 10);
  EXPECT_DOUBLE_EQ(order->dead_man_s, 0.1);
  EXPECT_EQ(order->epoch, kEpoch);
  EXPECT_EQ(order->hand, 31U) << "the cycle knows whose it is";
  EXPECT_FALSE(intake.take(jog_of(8, 2), kParticipant, kEpoch, kJoints, kTool_mm, 0))
      << "another one";
  intake.end();
  EXPECT_FALSE(intake.take(jog_of(7, 2), kParticipant, kEpoch, kJoints, kTool_mm, 0));
}

TEST(JogIntake, TakesNothingOfAnotherParticipantThatQuotesTheOperatorsNumber) {
  JogIntake intake(kService);
  intake.begin(7, kParticipant, 31);
  EXPECT_FALSE(intake.take(jog_of(7, 1), kParticipant + 1, kEpoch, kJoints, kTool_mm, 0));
  EXPECT_TRUE(intake.take(jog_of(7, 1), kParticipant, kEpoch, kJoints, kTool_mm, 0))
      << "nor does it count as the newest";
}

TEST(JogIntake, NeverTakesALateRepeatedOrOldSample) {
  JogIntake intake(kService);
  intake.begin(7, kParticipant, 31);
  ASSERT_TRUE(intake.take(jog_of(7, 5), kParticipant, kEpoch, kJoints, kTool_mm, 0));
  EXPECT_FALSE(intake.take(jog_of(7, 5), kParticipant, kEpoch, kJoints, kTool_mm, 0));
  EXPECT_FALSE(intake.take(jog_of(7, 4), kParticipant, kEpoch, kJoints, kTool_mm, 0));
  EXPECT_FALSE(intake.take(jog_of(7, 6), kParticipant, kEpoch + 1, kJoints, kTool_mm, 0))
      << "of an epoch that is over";
  intake.begin(7, kParticipant, 31);
  EXPECT_FALSE(intake.take(jog_of(7, 5), kParticipant, kEpoch, kJoints, kTool_mm, 0))
      << "of the jog before";
  EXPECT_TRUE(intake.take(jog_of(7, 6), kParticipant, kEpoch, kJoints, kTool_mm, 0));
}

TEST(JogIntake, CountsOrdersOfAllOperatorsAsOneRow) {
  JogIntake intake(kService);
  intake.begin(7, kParticipant, 31);
  const auto first = intake.take(jog_of(7, 5000), kParticipant, kEpoch, kJoints, kTool_mm, 0);
  intake.begin(9, kParticipant, 32);
  const auto second = intake.take(jog_of(9, 1), kParticipant, kEpoch, kJoints, kTool_mm, 0);
  ASSERT_TRUE(first && second);
  EXPECT_GT(second->sample, first->sample);
}

TEST(JogIntake, ReportsForHowLongASampleWasUnderWayAndTakesNoneOfAStatusThatNeverWas) {
  JogIntake intake(kService);
  intake.begin(7, kParticipant, 31);
  const auto late = intake.take(jog_of(7, 1), kParticipant, kEpoch, kJoints, kTool_mm, 70'000'000);
  ASSERT_TRUE(late);
  EXPECT_DOUBLE_EQ(late->age_s, 0.07);
  EXPECT_FALSE(intake.take(jog_of(7, 2), kParticipant, kEpoch, kJoints, kTool_mm, std::nullopt));
  dds::Jog stop = jog_of(7, 3);
  stop.velocity = 0;
  EXPECT_TRUE(intake.take(stop, kParticipant, kEpoch, kJoints, kTool_mm, std::nullopt))
      << "letting go always counts";
}

/// Every service counts its statuses from 1.
TEST(JogIntake, TakesNoSampleThatQuotesAnotherServiceButOneThatLetsGo) {
  JogIntake intake(kService);
  intake.begin(7, kParticipant, 31);
  dds::Jog jog = jog_of(7, 1);
  jog.service_id_seen = kService + 1;
  EXPECT_FALSE(intake.take(jog, kParticipant, kEpoch, kJoints, kTool_mm, 0));
  jog.service_id_seen = kService;
  EXPECT_TRUE(intake.take(jog, kParticipant, kEpoch, kJoints, kTool_mm, 0));
  jog = jog_of(7, 2);
  jog.service_id_seen = kService + 1;
  jog.velocity = 0;
  EXPECT_TRUE(intake.take(jog, kParticipant, kEpoch, kJoints, kTool_mm, 0));
}

TEST(JogIntake, PassesOverWhatIsNotSound) {
  JogIntake intake(kService);
  intake.begin(7, kParticipant, 31);
  std::uint64_t sample = 0;
  const auto is_taken = [&](auto change) {
    dds::Jog jog = jog_of(7, ++sample);
    change(jog);
    return intake.take(jog, kParticipant, kEpoch, kJoints, kTool_mm, 0).has_value();
  };
  EXPECT_FALSE(is_taken([](dds::Jog& jog) { jog.velocity = NAN; }));
  EXPECT_FALSE(is_taken([](dds::Jog& jog) { jog.distance = INFINITY; }));
  EXPECT_FALSE(is_taken([](dds::Jog& jog) { jog.distance = -1; }));
  EXPECT_FALSE(is_taken([](dds::Jog& jog) { jog.joint = kJoints; }));
  EXPECT_FALSE(is_taken([](dds::Jog& jog) { jog.dead_man_ns = 0; }));
  EXPECT_FALSE(is_taken([](dds::Jog& jog) { jog.frame = 1, jog.joint = kToolAxisCount; }));
  EXPECT_FALSE(is_taken([](dds::Jog& jog) { jog.frame = 2; })) << "a frame that nobody knows";
  EXPECT_TRUE(is_taken([](dds::Jog& jog) { jog.dead_man_ns = INT64_MAX; })) << "500 ms of it";
}

}  // namespace
}  // namespace meridian::interpolator
