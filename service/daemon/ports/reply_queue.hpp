// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "meridian/cycle/spsc_ring.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::interpolator {

/// A reply as plain data.
struct QueuedReply {
  std::uint64_t request = 0, operator_id = 0, service_id = 0, requester = 0;
  Verb verb = Verb::kHold;
  bool is_accepted = false;
  Refusal refusal = Refusal::kNone;
  State state = State::kOff;
  std::uint16_t epoch = 0;
  std::array<char, dds::kMaxText + 1> text{};  ///< zero-terminated
};

/// Replies on their way from the commands thread to the thread that writes them: a bounded lane for
/// each participant, served in turn. Whoever is answered too much loses answers of his own; nobody
/// waits for anybody. One thread pushes, one pops; neither waits.
/// Proof: tests/unit/daemon/reply_queue_test.cpp.
class ReplyQueue {
 public:
  /// False: there is no room for that participant, or no lane; the reply is dropped.
  [[nodiscard]] bool try_push(const QueuedReply& reply) noexcept {
    Lane* lane = find_lane(reply.requester);
    return lane != nullptr && lane->replies.try_push(reply);
  }
  /// The next reply, of each lane in turn; false: there is none.
  [[nodiscard]] bool try_pop(QueuedReply& reply) noexcept {
    for (std::size_t n = 0; n < lanes_.size(); ++n) {
      next_ = (next_ + 1) % lanes_.size();
      if (lanes_[next_].replies.try_pop(reply)) return true;
    }
    return false;
  }

 private:
  struct Lane {
    std::uint64_t participant = 0;  ///< the pushing thread's
    SpscRing<QueuedReply, 256> replies;
  };

  /// The participant's lane; where it has none, one that is empty becomes his.
  [[nodiscard]] Lane* find_lane(std::uint64_t participant) noexcept {
    Lane* free = nullptr;
    for (Lane& lane : lanes_) {
      if (lane.participant == participant) return &lane;
      if (free == nullptr && lane.replies.empty()) free = &lane;
    }
    if (free != nullptr) free->participant = participant;
    return free;
  }

  std::array<Lane, 8> lanes_;
  std::size_t next_ = 0;  ///< the popping thread's
};

}  // namespace meridian::interpolator
