// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "integration/set_up_plant.hpp"
#include "service/machine/file/machine_file.hpp"

/// Work frames of a machine that runs: set, kept, published, and refused where they must not
/// change.
namespace meridian::test {
namespace {

class SetUp : public testing::Test {
 protected:
  void start() {
    plant.start_service();
    (void)plant.status();
  }
  void start_in_ready() {
    start();
    plant.start_drives();
    ASSERT_TRUE(plant.enable()) << plant.service().said();
  }
  /// Refused for that reason, and everything is as it was.
  void expect_refused(const FrameOrder& order, Refusal why) {
    const dds::MachineInfo before = reported_by(plant);
    const JointVector joints = plant.status().joints;
    const bool is_at_rest = plant.status().state != State::kRunning;
    const dds::Reply reply = anna.ask(order);
    EXPECT_FALSE(reply.is_accepted);
    EXPECT_EQ(reply.refusal, why) << reply.text;
    EXPECT_NE(reply.text.find("frame refused: "), std::string::npos) << reply.text;
    const dds::MachineInfo after = reported_by(plant);
    EXPECT_EQ(after.work_frames, before.work_frames);
    EXPECT_EQ(after.work_frame, before.work_frame);
    EXPECT_EQ(after.frame_origin_mm, before.frame_origin_mm);
    if (is_at_rest) {
      EXPECT_EQ(plant.status().joints, joints);
    }
  }

  Plant plant;
  SetUpOperator anna{plant, 100};
};

TEST_F(SetUp, IsPublishedByTheMachineTopicAndTheStatusAsSoonAsItIsAcknowledged) {
  start();
  const dds::MachineInfo bare = reported_by(plant);
  EXPECT_TRUE(bare.work_frames.empty());
  const FrameOrder set = order_of(FrameWord::kSet, 3, 12.5, "vice");
  dds::Reply reply = anna.ask(set);
  ASSERT_TRUE(reply.is_accepted) << reply.text;
  EXPECT_EQ(reply.text, "frame 3 set; work frame 0 (machine file) in force");
  dds::MachineInfo published = reported_by(plant);
  ASSERT_EQ(published.work_frames, std::vector{set.frame});
  EXPECT_EQ(published.work_frame, 0);
  EXPECT_EQ(published.frame_origin_mm, bare.frame_origin_mm);
  reply = anna.ask(order_of(FrameWord::kSelect, 3));
  ASSERT_TRUE(reply.is_accepted) << reply.text;
  EXPECT_EQ(reply.text, "work frame 3 (vice) in force");
  published = reported_by(plant);
  EXPECT_EQ(published.work_frame, 3);
  EXPECT_EQ(published.frame_origin_mm, (Array3{12.5, 0, 0}));
  ASSERT_TRUE(plant.runs_until([](const dds::Status& status) { return status.work_frame == 3; }));
  EXPECT_EQ(plant.status().frame,
            stream::frame_sum(published.frame_rotation, published.frame_origin_mm,
                              published.work_frames));
  reply = anna.ask(order_of(FrameWord::kSet, 3, 7));  // the one in force
  ASSERT_TRUE(reply.is_accepted) << reply.text;
  EXPECT_EQ(reported_by(plant).frame_origin_mm, (Array3{7, 0, 0}));
}

TEST_F(SetUp, SurvivesTheService) {
  start();
  ASSERT_TRUE(anna.ask(order_of(FrameWord::kSet, 54, -3, "tower")).is_accepted);
  ASSERT_TRUE(anna.ask(order_of(FrameWord::kSelect, 54)).is_accepted);
  const dds::MachineInfo before = reported_by(plant);
  plant.service().send_signal(SIGTERM);
  ASSERT_EQ(plant.service().wait(kToolPatience), 0) << plant.service().said();
  start();
  const dds::MachineInfo after = reported_by(plant);
  EXPECT_NE(after.service_id, before.service_id);
  EXPECT_EQ(after.work_frames, before.work_frames);
  EXPECT_EQ(after.work_frame, 54);
  EXPECT_EQ(after.frame_origin_mm, before.frame_origin_mm);
}

TEST_F(SetUp, IsRefusedWithTheReasonWhereItIsNone) {
  start();
  expect_refused(order_of(FrameWord::kSelect, 4), Refusal::kOutOfRange);
  expect_refused(order_of(FrameWord::kSet, 0), Refusal::kOutOfRange);
  expect_refused(order_of(FrameWord::kSet, 55), Refusal::kOutOfRange);
  expect_refused(order_of(FrameWord::kSet, 1, 1e6), Refusal::kOutOfRange);
  expect_refused(order_of(static_cast<FrameWord>(9), 1), Refusal::kOutOfRange);
}

TEST_F(SetUp, IsRefusedWhereItWouldBeKeptNowhere) {
  const auto service = plant.another_service();  // without a folder for it
  (void)plant.status();
  expect_refused(order_of(FrameWord::kSet, 1), Refusal::kNotJournalled);
}

TEST_F(SetUp, StaysAsItIsWhileAProgramIsThereOrTheMachineMoves) {
  start_in_ready();
  const FrameOrder set = order_of(FrameWord::kSet, 1, 5);
  ASSERT_TRUE(plant.stream(small_program(60, 600, 5), [&](const stream::Station& station) {
    return station.state() == stream::StationState::kComplete &&
           plant.status().state == State::kLoaded;
  })) << plant.station().message();
  expect_refused(set, Refusal::kProgramPresent);
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  ASSERT_TRUE(plant.wait_for(State::kRunning)) << plant.standing();
  expect_refused(set, Refusal::kWrongState);
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kHold));
  ASSERT_TRUE(plant.wait_for(State::kHeld)) << plant.standing();
  expect_refused(set, Refusal::kProgramPresent);
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kAbort));
  ASSERT_TRUE(plant.wait_for(State::kReady)) << plant.standing();
  // The session is over a moment later than the motion.
  dds::Reply reply;
  EXPECT_TRUE(eventually([&] {
    reply = anna.ask(set);
    return reply.is_accepted;
  })) << reply.text;
}

TEST_F(SetUp, StaysAsItIsWhileASessionIsOpenInOff) {
  start();
  ASSERT_TRUE(plant.stream(small_program(5, 600), [](const stream::Station& station) {
    return station.state() == stream::StationState::kComplete;
  })) << plant.station().message();
  expect_refused(order_of(FrameWord::kSet, 1, 5), Refusal::kProgramPresent);
}

TEST_F(SetUp, ObeysOneOfTwoOperatorsWhoSawTheSame) {
  start();
  SetUpOperator bert(plant, 200);
  for (int round = 1; round <= 5; ++round) {
    SCOPED_TRACE(round);
    const dds::Status seen = plant.status();
    anna.say(order_of(FrameWord::kSet, 1, round, "anna"), seen);
    bert.say(order_of(FrameWord::kSet, 1, -round, "bert"), seen);
    const auto a = anna.answer(), b = bert.answer();
    ASSERT_TRUE(a && b);
    if (!a->is_accepted && !b->is_accepted) continue;  // the host was slow: both saw an old status
    ASSERT_NE(a->is_accepted, b->is_accepted) << a->text << "\n" << b->text;
    EXPECT_EQ((a->is_accepted ? b : a)->refusal, Refusal::kStale);
    const auto frames = reported_by(plant).work_frames;
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames.front().origin_mm[0], a->is_accepted ? round : -round);
    EXPECT_STREQ(frames.front().name.data(), a->is_accepted ? "anna" : "bert");
  }
}

TEST_F(SetUp, IsStaleForWhoHasNotSeenTheChangeBeforeIt) {
  start();
  const dds::Status before = plant.status();
  ASSERT_TRUE(anna.ask(order_of(FrameWord::kSet, 1, 1)).is_accepted);
  SetUpOperator bert(plant, 200);
  bert.say(order_of(FrameWord::kSet, 1, 2), before);
  const auto late = bert.answer();
  ASSERT_TRUE(late);
  EXPECT_EQ(late->refusal, Refusal::kStale) << late->text;
  const auto enable = plant.say_having_seen(Verb::kEnable, before);
  ASSERT_TRUE(enable);
  EXPECT_EQ(enable->refusal, Refusal::kStale) << enable->text;
  EXPECT_EQ(reported_by(plant).work_frames.front().origin_mm[0], 1);
}

TEST_F(SetUp, DoesAWordOnceThatIsRepeated) {
  start();
  anna.say(order_of(FrameWord::kSet, 1, 1), plant.status());
  for (int n = 0; n < 5; ++n) anna.repeat();
  const auto first = anna.answer();
  ASSERT_TRUE(first && first->is_accepted) << (first ? first->text : "no answer");
  const dds::Status after = plant.status();
  anna.repeat();
  const auto again = anna.answer();
  ASSERT_TRUE(again);
  EXPECT_EQ(again->text, first->text);
  EXPECT_TRUE(again->is_accepted);
  EXPECT_EQ(plant.status().service_id, after.service_id);
}

TEST_F(SetUp, RefusesAProgramThatWasCheckedUnderAnotherFrame) {
  start();
  const std::uint64_t old_sum = plant.status().frame;
  ASSERT_TRUE(anna.ask(order_of(FrameWord::kSet, 2, 1)).is_accepted);
  ASSERT_TRUE(anna.ask(order_of(FrameWord::kSelect, 2)).is_accepted);
  ASSERT_TRUE(plant.runs_until([](const dds::Status& status) { return status.work_frame == 2; }));
  SetUpStation station(plant);
  ASSERT_TRUE(station.is_connected());
  const dds::Credit stale = station.open(51, {.frame = old_sum});
  EXPECT_EQ(stale.verdict, dds::Verdict::kRefusedProgram);
  EXPECT_NE(stale.text.find("stale: "), std::string::npos) << stale.text;
  EXPECT_EQ(plant.status().session, 0U);
  EXPECT_EQ(station.open(52, {.frame = plant.status().frame}).verdict, dds::Verdict::kGood);
}

TEST_F(SetUp, LetsAProgramInOrAFrameAndNeverBoth) {
  start();
  ASSERT_TRUE(anna.ask(order_of(FrameWord::kSet, 1, 100)).is_accepted);
  ASSERT_TRUE(anna.ask(order_of(FrameWord::kSelect, 1)).is_accepted);
  ASSERT_TRUE(plant.runs_until([](const dds::Status& status) { return status.work_frame == 1; }));
  dds::Writer<dds::SessionRequest> requests(plant.participant());
  dds::Reader<dds::Credit> credits(plant.participant());
  ASSERT_TRUE(
      eventually([&] { return requests.matched_readers() > 0 && credits.matched_writers() > 0; },
                 kToolPatience));
  int opened = 0, changed = 0;
  for (int round = 1; round <= 12; ++round) {
    SCOPED_TRACE(round);
    const dds::Status seen = plant.status();
    dds::SessionRequest request;
    request.session = 100 + static_cast<std::uint64_t>(round);
    request.station = "cam";
    request.program = "part.apt";
    request.frame = seen.frame;
    // Who comes first has to wait a little longer each round.
    const bool is_program_first = round % 2 == 0;
    if (is_program_first) (void)requests.write(request);
    anna.say(order_of(FrameWord::kSet, 1, round), seen);
    if (!is_program_first) {
      std::this_thread::sleep_for(milliseconds(round));
      (void)requests.write(request);
    }
    dds::Credit credit;
    ASSERT_TRUE(
        eventually([&] { return credits.take(credit) && credit.session == request.session; }));
    const auto reply = anna.answer();
    ASSERT_TRUE(reply);
    const bool is_open = credit.verdict == dds::Verdict::kGood;
    EXPECT_FALSE(is_open && reply->is_accepted) << credit.text << "\n" << reply->text;
    if (!is_open) {
      const bool is_reported = credit.text.find("work frame") != std::string::npos ||
                               credit.text.find("set-up is being changed") != std::string::npos;
      EXPECT_TRUE(is_reported) << credit.text;
    }
    ++(is_open ? opened : changed);
    const bool is_in_force = reported_by(plant).frame_origin_mm[0] == round;
    EXPECT_EQ(is_in_force, reply->is_accepted) << reply->text;
    request.request = dds::SessionRequestKind::kClose;
    (void)requests.write(request);
    ASSERT_TRUE(plant.runs_until([](const dds::Status& status) { return status.session == 0; }));
    ASSERT_TRUE(plant.runs_until([&](const dds::Status& status) {
      return status.status_sequence > seen.status_sequence + 1;
    }));
  }
  std::printf("%d programs let in, %d frames\n", opened, changed);
}

TEST_F(SetUp, IsTheToolsForPosesAndPrograms) {
  start();
  const std::string at = "4,-3,2.5,0.3,-0.2,7";
  Process set = tool(plant, {"ctl", "frame", "set", "9", "--at", at, "--name", "plate"});
  ASSERT_EQ(set.wait(kToolPatience), 0) << set.said();
  Process select = tool(plant, {"ctl", "frame", "select", "9"});
  ASSERT_EQ(select.wait(kToolPatience), 0) << select.said();
  Process list = tool(plant, {"ctl", "frame", "list"});
  ASSERT_EQ(list.wait(kToolPatience), 0) << list.said();
  EXPECT_NE(list.said().find("*  9  --at " + at + "  plate\n"), std::string::npos) << list.said();
  Process live = tool(plant, {"pose", "--json", "10", "5", "150", "0", "0.6", "0.8"});
  ASSERT_EQ(live.wait(kToolPatience), 0) << live.said();
  const std::string joints = live.said();
  Process file({"meridian", "pose", "--machine", plant.machine(), "--frame", at, "--json", "10",
                "5", "150", "0", "0.6", "0.8"},
               plant.folder() / "pose.log");
  ASSERT_EQ(file.wait(kToolPatience), 0) << file.said();
  EXPECT_EQ(joints, file.said());
  Process clear = tool(plant, {"ctl", "frame", "clear", "9"});
  EXPECT_EQ(clear.wait(kToolPatience), 4) << clear.said();
  EXPECT_NE(clear.said().find("frame 9 is in force; select another one first"), std::string::npos)
      << clear.said();
}

}  // namespace
}  // namespace meridian::test
