// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/threads/planner_thread.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/time_law.hpp"
#include "support/machines.hpp"

namespace meridian::interpolator {
namespace {

/// The planner's thread between a queue that the test fills and a motion port that it empties.
class PlannerThreadTest : public testing::Test {
 protected:
  PlannerThreadTest() : machine_(machine()), planner_(machine_, {}, *ports_) {
    reader_.set_epoch(1);
    show(1);
    ports_->spindle_tool_mm = machine_.tool_length_mm;
    thread_ = std::thread([this] { planner_.run(); });
  }
  ~PlannerThreadTest() override {
    ports_->is_stopping = true;
    ports_->planner_wake.notify();
    thread_.join();
  }

  [[nodiscard]] static MachineModel machine() {
    MachineModel model = test::lai_machine();
    model.max_feed_override = 1.5;
    return model;
  }
  /// The machine is in Ready at home, in `epoch`.
  void show(std::uint16_t epoch) {
    CycleView view;
    view.record.state = State::kReady;
    view.epoch = epoch;
    ports_->planner_view.store(view);
  }
  /// Twenty cuts to and fro that take more than a second each, and the end.
  void push_program() {
    const ToolPose home = forward(machine_, machine_.tool_length_mm, JointVector{});
    SmoothSettings settings;
    settings.transition = Transition::kExactStop;
    ports_->session_settings.store({1, settings});
    ClBlock block;
    block.axis = to_array(home.axis);
    block.feed_meaning = FeedMeaning::kTip;
    block.feed = 10;
    for (int i = 0; i <= 20; ++i) {
      block.kind = i < 20 ? BlockKind::kCut : BlockKind::kEnd;
      block.tip_mm = to_array(home.tip + Vector3(i % 2 == 0 ? 12 : 0, 0, 0));
      block.sequence = static_cast<std::uint64_t>(i);
      ASSERT_TRUE(ports_->blocks.stage({1, block}));
    }
    pushed_ += 21;
    ports_->blocks.publish();
    ports_->planner_wake.notify();
  }
  [[nodiscard]] bool has_piece() {
    for (int i = 0; i < 500 && reader_.advance() == nullptr; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return reader_.piece() != nullptr;
  }

  /// Whether the newest approach that operators hear of is one in `epoch`.
  [[nodiscard]] bool is_approach_declared(std::uint16_t epoch) {
    Approach approach;
    for (int i = 0; i < 500 && !(approach.is_planned && approach.epoch == epoch); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      ports_->approach.load(approach);
    }
    return approach.is_planned && approach.epoch == epoch;
  }

  const MachineModel machine_;
  const std::unique_ptr<Ports> ports_ = std::make_unique<Ports>();
  MotionReader reader_{ports_->motion};
  PlannerThread planner_;
  std::uint64_t pushed_ = 0;
  std::thread thread_;
};

TEST_F(PlannerThreadTest, PlansAProgramBehindOneThatWasAbortedWithSecondsOfPlanAhead) {
  ASSERT_NO_FATAL_FAILURE(push_program());
  ASSERT_TRUE(has_piece());
  EXPECT_TRUE(is_approach_declared(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // as far ahead as it goes
  EXPECT_FALSE(ports_->blocks.empty()) << "the whole program is planned: nothing is far ahead";
  reader_.set_epoch(2);
  show(2);
  ports_->queue_mark.store({pushed_, 2});
  ASSERT_NO_FATAL_FAILURE(push_program());
  EXPECT_TRUE(has_piece()) << "what is void was waited for";
  EXPECT_TRUE(is_approach_declared(2));
}

TEST_F(PlannerThreadTest, PlansWhatItHasToItsEndWhereASessionIsCutOff) {
  const ToolPose home = forward(machine_, machine_.tool_length_mm, JointVector{});
  constexpr int kCuts = 30;
  SmoothSettings settings;
  settings.transition = Transition::kSmooth;
  ports_->session_settings.store({1, settings});
  QueuedBlock queued{1, {}};
  queued.block.axis = to_array(home.axis);
  queued.block.feed_meaning = FeedMeaning::kTip;
  queued.block.feed = 100;
  for (int i = 1; i <= kCuts; ++i) {
    queued.block.tip_mm = to_array(home.tip + Vector3(i, 0, 0));
    queued.block.sequence = static_cast<std::uint64_t>(i - 1);
    ASSERT_TRUE(ports_->blocks.stage(queued));
  }
  queued.is_cut_off = true;
  ASSERT_TRUE(ports_->blocks.stage(queued));
  ports_->blocks.publish();
  ports_->planner_wake.notify();
  double left_mm = 1e9;
  for (int i = 0; i < 1000 && left_mm > 1e-6; ++i) {
    while (reader_.advance() != nullptr) {
      if (reader_.path() == nullptr) continue;
      const PathState end = state_at(*reader_.piece(), reader_.piece()->duration);
      const Vector3 tip = pose_at(*reader_.path(), end.s).tip;
      if (end.ds < 1e-6) left_mm = (tip - home.tip - Vector3(kCuts, 0, 0)).norm();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_LE(left_mm, 1e-6) << "the last block was sent and is not cut";
  FeedMark mark;
  std::uint64_t looked_at = 0;
  while (ports_->feed_marks.try_pop(mark)) looked_at = std::max(looked_at, mark.looked_at);
  EXPECT_EQ(looked_at, kCuts);
}

}  // namespace
}  // namespace meridian::interpolator
