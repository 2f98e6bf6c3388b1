// SPDX-License-Identifier: Apache-2.0
// The soft limits of the set-up: what a word about them says, and what is answered.
#include "service/daemon/supervisor/supervisor.hpp"
#include "service/recording/telemetry/journal/set_up_text.hpp"

namespace meridian::interpolator {

LimitsOrder Supervisor::read_limits_order(std::uint64_t key) noexcept {
  LimitsOrder nothing;
  nothing.word = static_cast<LimitsWord>(0xFF);
  auto& orders = ports_.set_up.limits;
  for (const LimitsArrival* at = orders.peek(0); at != nullptr && at->key <= key;
       at = orders.peek(0)) {
    const LimitsArrival arrival = *at;
    orders.drop(1);
    if (arrival.key == key) return arrival.order;
  }
  return nothing;
}

bool Supervisor::change_limits(const Pending& command) {
  const LimitsOrder& order = command.request.limits;
  const LimitsFault fault = next_set_up_.limits.apply(order, model_);
  if (fault == LimitsFault::kNone) return true;
  reply(command, false, Refusal::kOutOfRange,
        "limits refused: " + telemetry::describe(fault, order.joint, model_));
  return false;
}

std::string Supervisor::words_of_limits() const {
  return set_up_.limits.empty() ? "every joint has its whole travel, no box is put up"
                                : telemetry::limits_text(set_up_.limits, model_) + " in force";
}

}  // namespace meridian::interpolator
