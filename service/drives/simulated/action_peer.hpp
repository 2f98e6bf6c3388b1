// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "service/transport/convert/messages.hpp"

namespace meridian::drives {

/// Plays the PLC: takes actions (spindle, coolant, tool change, stop, vendor word) and says done
/// after a delay, or refuses. Proof: tests/unit/simulated_drives/action_peer_test.cpp.
class ActionPeer {
 public:
  ActionPeer(std::int64_t delay_ns, bool is_refusing)
      : delay_ns_(delay_ns), is_refusing_(is_refusing) {}

  void take(const dds::Action& action, std::int64_t now_ns) {
    due_.push_back({now_ns + delay_ns_, action});
  }

  /// Returns an answer that is due; call until it returns nothing.
  [[nodiscard]] std::optional<dds::ActionDone> due_answer(std::int64_t now_ns) {
    if (due_.empty() || due_.front().at_ns > now_ns) return std::nullopt;
    dds::ActionDone done;
    done.id = due_.front().action.id;
    done.service_id = due_.front().action.service_id;
    done.is_done = !is_refusing_;
    if (is_refusing_) done.text = "refused: the simulated PLC was told to";
    due_.pop_front();
    return done;
  }

 private:
  struct Due {
    std::int64_t at_ns;
    dds::Action action;
  };
  std::int64_t delay_ns_;
  bool is_refusing_;
  std::deque<Due> due_;
};

}  // namespace meridian::drives
