// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/operator/probe_run.hpp"

#include <utility>

#include "meridian/cycle/state_table.hpp"
#include "service/protocol/steady_ns.hpp"

namespace meridian::stream {
namespace {

/// Waits until the machine is free of the move, and its status says what came of it. False where
/// it is not in time.
[[nodiscard]] bool wait_until_free(OperatorLink& link) {
  constexpr std::chrono::milliseconds kLookFree{20};
  constexpr std::int64_t kPatience_ns = 2'000'000'000;
  const std::int64_t begin_ns = steady_ns();
  const auto is_free = [&link] {
    const auto& status = link.status();
    return status && status->session == 0 && !is_on_path(status->state);
  };
  while (!is_free() && steady_ns() - begin_ns < kPatience_ns) (void)link.wait_for_status(kLookFree);
  return is_free();
}

[[nodiscard]] ProbeEnd end_of(MoveEnd end, bool has_contact) {
  switch (end) {
    case MoveEnd::kRefused:
      return ProbeEnd::kRefused;
    case MoveEnd::kNoAnswer:
      return ProbeEnd::kNoAnswer;
    case MoveEnd::kThere:
    case MoveEnd::kStopped:
      break;
  }
  if (has_contact) return ProbeEnd::kContact;
  return end == MoveEnd::kThere ? ProbeEnd::kNoContact : ProbeEnd::kStopped;
}

}  // namespace

ProbeResult run_probe(dds::Participant& participant, OperatorLink& link, MoveOrder order,
                      const std::atomic<bool>& is_stopping, std::chrono::milliseconds timeout) {
  order.is_probing = true;
  const dds::Status before = link.status().value_or(dds::Status());
  MoveResult moved = run_move(participant, link, order, is_stopping, timeout);
  const bool has_ended = moved.end == MoveEnd::kThere || moved.end == MoveEnd::kStopped;
  const bool is_free = has_ended && wait_until_free(link);
  ProbeResult result{ProbeEnd::kNoAnswer, std::move(moved.text), {}};
  if (link.status()) result.status = *link.status();
  if (has_ended && !is_free) return result;
  const bool is_same = result.status.service_id == before.service_id;
  result.end =
      end_of(moved.end, has_ended && is_same && result.status.contacts == before.contacts + 1);
  result.was_stopped = result.status.stops != before.stops;
  return result;
}

}  // namespace meridian::stream
