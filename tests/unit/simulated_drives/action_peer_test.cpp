// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/action_peer.hpp"

#include <gtest/gtest.h>

#include "service/drives/kit/actions/action_words.hpp"

namespace meridian::drives {
namespace {

dds::Action action(std::uint64_t id) {
  dds::Action asked;
  asked.id = id;
  asked.service_id = 9;
  asked.kind = ActionKind::kSpindleClockwise;
  asked.value = 8000;
  return asked;
}

TEST(SimulatedPlc, SaysDoneAfterItsDelay) {
  ActionPeer peer(100, false);
  peer.take(action(3), 1000);
  EXPECT_FALSE(peer.due_answer(1099));
  const auto done = peer.due_answer(1100);
  ASSERT_TRUE(done);
  EXPECT_EQ(done->id, 3u);
  EXPECT_EQ(done->service_id, 9u);
  EXPECT_TRUE(done->is_done);
  EXPECT_FALSE(peer.due_answer(2000));
}

TEST(SimulatedPlc, RefusesWhenAskedTo) {
  ActionPeer peer(0, true);
  peer.take(action(3), 0);
  const auto done = peer.due_answer(0);
  ASSERT_TRUE(done);
  EXPECT_FALSE(done->is_done);
  EXPECT_FALSE(done->text.empty());
}

TEST(SimulatedPlc, NamesTheActionWithItsValue) {
  EXPECT_EQ(drive::describe(action(1)), "spindle clockwise 8000 rev/min");
}

}  // namespace
}  // namespace meridian::drives
