// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

#include "service/protocol/operator/move_program.hpp"
#include "service/protocol/operator/operator_link.hpp"
#include "service/transport/participant.hpp"

namespace meridian::stream {

/// A move, and what it was checked with.
struct MoveOrder {
  StraightMove move;
  JointVector joints{};  ///< where the machine stands
  double tool_length_mm = 0;
  std::string station;       ///< who asks, for messages
  std::uint64_t frame = 0;   ///< frame_sum()
  std::uint64_t tools = 0;   ///< tools_sum(); 0: of none
  std::uint64_t limits = 0;  ///< limits_sum()
  bool is_probing = false;   ///< it ends where the probe has contact
};

enum class MoveEnd : std::uint8_t {
  kThere,    ///< the tip is where it was asked for
  kRefused,  ///< nothing moved
  kStopped,  ///< abort, fault, or the caller stopped it: the tip rests on its way
  kNoAnswer  ///< the service fell silent; what it does is not known
};

struct MoveResult {
  MoveEnd end = MoveEnd::kNoAnswer;
  std::string text;  ///< what the machine said last
};

/// Sends the move as a program of its own (dds::kPolicyMove), starts it in the name of `link`, and
/// stays until it is over. It is started only where the machine, which holds the program then,
/// stands as it was checked. Where it is not started, and once `is_stopping`, it is aborted, so
/// that the machine is free. One thread. Throws DdsError. Proof:
/// tests/integration/set_up_move_test.cpp.
[[nodiscard]] MoveResult run_move(dds::Participant& participant, OperatorLink& link,
                                  const MoveOrder& order, const std::atomic<bool>& is_stopping,
                                  std::chrono::milliseconds timeout);

}  // namespace meridian::stream
