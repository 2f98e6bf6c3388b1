// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string>

#include "service/telemetry/set_up_file.hpp"
#include "supervisor_rig.hpp"

namespace meridian::interpolator {
namespace {

namespace fs = std::filesystem;

/// The commands thread with a set-up; the test is the disk's thread, the cycle, the status and the
/// main thread.
class SupervisorFrames : public SupervisorTest {
 protected:
  SupervisorFrames() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~SupervisorFrames() override { fs::remove_all(folder_); }
  void SetUp() override {
    const WorkFrames none;
    supervisor_.keep_frames(file_, none, frame_in_force(none, model_, 0));
    run();
    show(State::kOff, false);
    ASSERT_TRUE(comes([this] { return ports_->may_leave.load(); }));
  }

  void say(FrameWord word, int number, double x_mm = 0) {
    dds::CommandRequest request;
    request.operator_id = 9;
    request.request = ++request_;
    request.verb = Verb::kFrame;
    request.epoch_seen = 1;
    request.status_seen = status_;
    request.frame.word = word;
    request.frame.frame.number = static_cast<std::uint8_t>(number);
    request.frame.frame.origin_mm = {x_mm, 0, 0};
    (void)commands_.write(request);
  }
  /// The disk does what it is asked for, until the cycle is told.
  [[nodiscard]] std::optional<Command> write_and_take() {
    Command command;
    const bool is_there = comes([&] {
      file_.work();
      return ports_->commands.try_pop(command);
    });
    return is_there && command.verb == Verb::kFrame ? std::optional(command) : std::nullopt;
  }
  void tell_accepted(const Command& command) {
    tell(EventCode::kAccepted, command.request, Verb::kFrame);
  }
  void tell_refused(const Command& command, Refusal why) {
    Event event;
    event.code = EventCode::kRefused;
    event.a = command.request;
    event.b = static_cast<std::uint64_t>(Verb::kFrame);
    event.x = static_cast<double>(why);
    ASSERT_TRUE(ports_->events.try_push(event));
  }
  /// Status and machine topic tell of what is in force.
  void tell_everybody() {
    ASSERT_TRUE(comes([this] { return supervisor_.has_frames_to_tell(); }));
    publish_status();
    ports_->frame.status = status_;
    ports_->frame.told = supervisor_.frame().change;
    supervisor_.frames_told();
  }
  [[nodiscard]] bool is_answered() {
    dds::Reply reply;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return replies_.take(reply);
  }
  /// x of a row on disk; 0: it is not there.
  [[nodiscard]] double on_disk(int number) {
    const auto frames = telemetry::SetUpFile(folder_, model_.name).read();
    EXPECT_TRUE(frames);
    const WorkFrame* const row = frames ? frames->find(number) : nullptr;
    return row != nullptr ? row->origin_mm[0] : 0;
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("meridian-frames-" + std::to_string(::getpid()));
  int error_ = 0;
  telemetry::SetUpFile file_{folder_, model_.name,
                             [this](const fs::path& path, const std::string& text) {
                               return error_ != 0 ? error_ : telemetry::replace_file(path, text);
                             }};
};

TEST_F(SupervisorFrames, AreOnDiskBeforeTheCycleAndToldBeforeTheyAreAcknowledged) {
  say(FrameWord::kSet, 3, 12);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  Command early;
  EXPECT_FALSE(ports_->commands.try_pop(early)) << "the disk has not written it";
  auto command = write_and_take();
  ASSERT_TRUE(command);
  EXPECT_EQ(on_disk(3), 12);
  EXPECT_FALSE(is_answered());
  tell_accepted(*command);
  EXPECT_FALSE(is_answered()) << "nobody was told";
  tell_everybody();
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kNone));

  say(FrameWord::kSelect, 3);
  command = write_and_take();
  ASSERT_TRUE(command);
  EXPECT_EQ(command->argument, 3);
  ASSERT_TRUE(ports_->frame.for_cycle.refresh());
  EXPECT_EQ(ports_->frame.for_cycle.latest().origin_mm, (Array3{12, 0, 0}));
  tell_accepted(*command);
  tell_everybody();
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kNone));
  ASSERT_TRUE(ports_->frame.for_planner.refresh() && ports_->frame.for_intake.refresh());
  EXPECT_EQ(ports_->frame.for_planner.latest().number, 3);
  EXPECT_EQ(ports_->frame.for_intake.latest().sum, supervisor_.frame().sum);
}

TEST_F(SupervisorFrames, AreTakenOffTheDiskAgainWhereTheCycleRefusesThem) {
  say(FrameWord::kSet, 3, 12);
  const auto command = write_and_take();
  ASSERT_TRUE(command);
  tell_refused(*command, Refusal::kProgramPresent);
  ASSERT_TRUE(comes([&] {
    file_.work();
    return on_disk(3) == 0;
  }));
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kProgramPresent));
  EXPECT_FALSE(ports_->frame.for_planner.refresh());
  EXPECT_TRUE(supervisor_.frames().rows().empty());
  EXPECT_TRUE(comes([this] {
    return ports_->frame.claim.try_take(ProgramClaim::Holder::kSession);
  })) << "programs are let in again";
}

TEST_F(SupervisorFrames, AreRefusedWithTheDisksReason) {
  error_ = ENOSPC;
  say(FrameWord::kSet, 3, 12);
  dds::Reply reply;
  ASSERT_TRUE(comes([&] {
    file_.work();
    return replies_.take(reply);
  }));
  EXPECT_EQ(reply.refusal, Refusal::kNotJournalled);
  EXPECT_NE(reply.text.find("No space left on device"), std::string::npos) << reply.text;
  Command command;
  EXPECT_FALSE(ports_->commands.try_pop(command));
}

TEST_F(SupervisorFrames, WaitForNoProgramAndLetNoneIn) {
  ASSERT_TRUE(ports_->frame.claim.try_take(ProgramClaim::Holder::kSession));
  say(FrameWord::kSet, 3, 12);
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kProgramPresent));
  ports_->frame.claim.give_back(ProgramClaim::Holder::kSession);
  say(FrameWord::kSet, 3, 12);
  ASSERT_TRUE(write_and_take());
  EXPECT_FALSE(ports_->frame.claim.try_take(ProgramClaim::Holder::kSession));
}

TEST_F(SupervisorFrames, AreAskedForOnceMoreWhereTheCyclesAnswerWasLost) {
  say(FrameWord::kSet, 3, 12);
  ASSERT_TRUE(write_and_take());
  ask(Verb::kSingleBlock, 1);
  const auto behind = take(Verb::kSingleBlock);
  ASSERT_TRUE(behind);
  tell(EventCode::kAccepted, behind->request, Verb::kSingleBlock);
  const auto again = take(Verb::kFrame);
  ASSERT_TRUE(again);
  tell_accepted(*again);
  tell_everybody();
  EXPECT_TRUE(has_reply(Verb::kSingleBlock, Refusal::kNone));
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kNone));
}

TEST_F(SupervisorFrames, AreSetOneAtATimeAndByWhoHasSeenTheLast) {
  say(FrameWord::kSet, 3, 12);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  say(FrameWord::kSet, 3, 13);
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kStale));
  const auto command = write_and_take();
  ASSERT_TRUE(command);
  tell_accepted(*command);
  tell_everybody();
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kNone));
  --status_;  // what was published before
  say(FrameWord::kSet, 3, 14);
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kStale));
  ask(Verb::kEnable);
  EXPECT_TRUE(has_reply(Verb::kEnable, Refusal::kStale));
  ++status_;
  say(FrameWord::kSet, 3, 15);
  EXPECT_TRUE(write_and_take());
  EXPECT_EQ(on_disk(3), 15);
}

}  // namespace
}  // namespace meridian::interpolator
