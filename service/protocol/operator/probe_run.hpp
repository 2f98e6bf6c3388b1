// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

#include "service/protocol/operator/move_run.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::stream {

enum class ProbeEnd : std::uint8_t {
  kContact,    ///< the probe had contact, and the tip rests behind it
  kNoContact,  ///< the tip is at the end of the move, and the probe touched nothing
  kRefused,    ///< nothing moved
  kStopped,    ///< abort, fault, or the caller stopped it: the tip rests on its way
  kNoAnswer    ///< the service fell silent; what it does is not known
};

struct ProbeResult {
  ProbeEnd end = ProbeEnd::kNoAnswer;
  std::string text;          ///< what the machine said last
  dds::Status status;        ///< of the machine at rest; kContact: with the contact
  bool was_stopped = false;  ///< somebody stopped the machine meanwhile, or it was held
};

/// run_move() of a move that ends where the probe has contact. One thread. Throws DdsError.
/// Proof: tests/integration/set_up_probe_test.cpp.
[[nodiscard]] ProbeResult run_probe(dds::Participant& participant, OperatorLink& link,
                                    MoveOrder order, const std::atomic<bool>& is_stopping,
                                    std::chrono::milliseconds timeout);

}  // namespace meridian::stream
