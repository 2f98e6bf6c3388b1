// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/ports/queue_follower.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "support/draws.hpp"

namespace meridian::interpolator {
namespace {

/// Cycle and intake in the order in which they act, one step at a time.
class World {
 public:
  World() : ports(std::make_unique<Ports>()) { show(State::kReady); }

  void show(State state) {
    view_.record.state = state;
    view_.epoch = epoch;
    view_.cycles_run = ++cycles;
    ports->planner_view.store(view_);
  }
  void advance_epoch(State state) {
    ++epoch;
    show(state);
  }
  void push(int count) {
    for (int i = 0; i < count; ++i) {
      ASSERT_TRUE(ports->blocks.stage({meant_for, {}}));
      ++pushed;
    }
    ports->blocks.publish();
  }
  void empty_queue() {
    meant_for = epoch;
    ports->queue_mark.store({pushed, epoch});
  }

  std::unique_ptr<Ports> ports;
  std::uint16_t epoch = 1;
  std::uint64_t pushed = 0, cycles = 0;
  std::uint64_t meant_for = 1;  ///< epoch of blocks that are pushed now; stands in their `session`

 private:
  CycleView view_;
};

/// Abort of a loaded program with `late` blocks that come in before intake has heard of it, and the
/// next program.
std::vector<std::function<void(World&)>> abort_and_load_another(int late) {
  return {[](World& w) { w.show(State::kLoaded); },
          [late](World& w) { w.push(2 * late); },
          [](World& w) { w.advance_epoch(State::kReady); },
          [late](World& w) { w.push(late); },
          [](World& w) { w.empty_queue(); },
          [](World& w) { w.push(1); },
          [](World& w) { w.push(2); }};
}

/// Lets `script` run through the looks of a planner, `cuts[i]` steps before its look i; the rest
/// of the script before those that follow. Every block that is in step must be meant for the epoch
/// of the view, and in the end those of the new program must have been in step, each once.
void run(const std::vector<std::size_t>& cuts, int blocks_before, int late) {
  World world;
  world.push(blocks_before);
  QueueFollower queue(*world.ports);
  const auto script = abort_and_load_another(late);
  std::size_t at = 0, cut = 0;
  const auto pause = [&] {
    const std::size_t count = cut < cuts.size() ? cuts[cut++] : script.size();
    for (std::size_t i = 0; i < count && at < script.size(); ++i) script[at++](world);
  };
  int planned_of_new = 0;
  for (int looks = 0; looks < 40; ++looks) {
    const auto look = queue.look(pause);
    pause();
    if (!look.is_in_step || look.front == nullptr) continue;
    ASSERT_EQ(look.front->session, queue.view().epoch);
    planned_of_new += look.front->session == 2 ? 1 : 0;
    queue.pop();
  }
  EXPECT_EQ(planned_of_new, 3) << "no block of the new program is lost, none comes twice";
}

TEST(QueueFollower, PlansABlockOnlyForTheEpochItWasMeantForWhereverItIsHeldUp) {
  const std::size_t steps = abort_and_load_another(0).size();
  constexpr std::size_t kEvery = test::kIsTimed ? 1 : 3;  // a sanitizer sees the same code in some
  for (int before = 0; before <= 3; ++before) {
    for (std::size_t a = 0; a <= steps; ++a) {
      for (std::size_t b = 0; a + b <= steps; ++b) {
        for (std::size_t c = 0; a + b + c <= steps; ++c) {
          for (std::size_t d = 0; a + b + c + d <= steps; d += kEvery) {
            SCOPED_TRACE(std::to_string(before) + " blocks, cuts " + std::to_string(a) + " " +
                         std::to_string(b) + " " + std::to_string(c) + " " + std::to_string(d));
            ASSERT_NO_FATAL_FAILURE(run({a, b, c, d}, before / 2, before % 2));
            if (testing::Test::HasFailure()) return;
          }
        }
      }
    }
  }
}

TEST(QueueFollower, BeginsAProgramFromTheReadyAfterTheOneBeforeNotFromOneBeforeThat) {
  for (int held_at = 0; held_at < 6; ++held_at) {
    World world;
    QueueFollower queue(*world.ports);
    int pauses = 0;
    const auto other_program_runs_and_the_next_comes = [&] {
      if (pauses++ != held_at) return;
      world.show(State::kRunning);
      world.show(State::kReady);
      world.push(1);
    };
    for (int looks = 0; looks < 4; ++looks) {
      const auto look = queue.look(other_program_runs_and_the_next_comes);
      if (look.front == nullptr) continue;
      EXPECT_TRUE(look.is_in_step);
      EXPECT_EQ(queue.view().cycles_run, world.cycles) << "held at look " << held_at;
    }
  }
}

TEST(QueueFollower, FindsTheQueueEmptyAfterMoreBlocksWereVoidedThanItHadEverSeen) {
  World world;
  world.push(3);
  QueueFollower queue(*world.ports);
  ASSERT_NE(queue.look().front, nullptr);
  world.push(90);
  world.advance_epoch(State::kReady);
  world.empty_queue();
  EXPECT_TRUE(queue.look().is_emptied);
  EXPECT_EQ(queue.look().front, nullptr) << "a block that nobody sent";
  EXPECT_EQ(world.ports->blocks.size(), 0U);
  world.push(1);
  const auto look = queue.look();
  EXPECT_TRUE(look.is_in_step);
  ASSERT_NE(look.front, nullptr);
  EXPECT_EQ(look.front->session, 2U);
}

TEST(QueueFollower, KeepsTheQueueWhereOnlyTheEpochOfItsBlocksIsNew) {
  World world;
  world.push(2);
  QueueFollower queue(*world.ports);
  ASSERT_TRUE(queue.look().is_in_step);
  world.advance_epoch(State::kReady);
  EXPECT_FALSE(queue.look().is_in_step) << "intake has not heard of it";
  world.ports->queue_mark.store({0, world.epoch});
  const auto look = queue.look();
  EXPECT_TRUE(look.is_in_step);
  EXPECT_NE(look.front, nullptr);
}

TEST(QueueFollower, HearsOfAQueueThatIsEmptiedInTheSameEpoch) {
  World world;
  world.push(2);
  QueueFollower queue(*world.ports);
  ASSERT_TRUE(queue.look().is_in_step);
  queue.pop();
  queue.pop();
  world.empty_queue();
  EXPECT_TRUE(queue.look().is_emptied) << "what was refused is over";
  EXPECT_TRUE(queue.look().is_in_step);
}

}  // namespace
}  // namespace meridian::interpolator
