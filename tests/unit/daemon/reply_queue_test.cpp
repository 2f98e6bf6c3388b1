// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/ports/reply_queue.hpp"

#include <gtest/gtest.h>

#include <map>
#include <memory>

namespace meridian::interpolator {
namespace {

QueuedReply reply_to(std::uint64_t participant, std::uint64_t request) {
  QueuedReply reply;
  reply.requester = participant;
  reply.request = request;
  return reply;
}

TEST(ReplyQueue, ServesEveryParticipantInTurnHoweverManyWaitForOne) {
  const auto queue = std::make_unique<ReplyQueue>();
  for (std::uint64_t n = 0; n < 200; ++n) ASSERT_TRUE(queue->try_push(reply_to(1, n)));
  ASSERT_TRUE(queue->try_push(reply_to(2, 7)));
  QueuedReply reply;
  ASSERT_TRUE(queue->try_pop(reply));
  if (reply.requester == 1) {
    ASSERT_TRUE(queue->try_pop(reply));
  }
  EXPECT_EQ(reply.requester, 2U);
  EXPECT_EQ(reply.request, 7U);
}

TEST(ReplyQueue, DropsWhatIsTooMuchForOneParticipantAndNothingOfAnother) {
  const auto queue = std::make_unique<ReplyQueue>();
  std::uint64_t kept = 0;
  while (queue->try_push(reply_to(1, kept))) ++kept;
  EXPECT_EQ(kept, 256U);
  EXPECT_TRUE(queue->try_push(reply_to(2, 0)));
  std::map<std::uint64_t, std::uint64_t> next;
  for (QueuedReply reply; queue->try_pop(reply);) {
    EXPECT_EQ(reply.request, next[reply.requester]++) << "in order";
  }
  EXPECT_EQ(next[1], kept);
  EXPECT_EQ(next[2], 1U);
}

TEST(ReplyQueue, GivesALaneThatIsEmptyToWhoeverComes) {
  const auto queue = std::make_unique<ReplyQueue>();
  for (std::uint64_t participant = 1; participant <= 1000; ++participant) {
    ASSERT_TRUE(queue->try_push(reply_to(participant, 1)));
    QueuedReply reply;
    ASSERT_TRUE(queue->try_pop(reply));
    EXPECT_EQ(reply.requester, participant);
  }
  for (std::uint64_t participant = 1; participant <= 8; ++participant) {
    ASSERT_TRUE(queue->try_push(reply_to(participant, 1)));
  }
  EXPECT_FALSE(queue->try_push(reply_to(9, 1))) << "all lanes are taken";
}

}  // namespace
}  // namespace meridian::interpolator
