// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "service/protocol/intake_check.hpp"
#include "support/machines.hpp"
#include "support/programs.hpp"

namespace meridian::stream {

using dds::Batch;
using dds::Credit;
using dds::Verdict;
using test::good_batch;

inline constexpr std::uint64_t kSession = 0xabc;

inline dds::SessionRequest open_request(std::uint64_t session = kSession,
                                        const std::string& station = "cam-1") {
  return {.session = session, .station = station, .program = "part.cls"};
}

class Intake : public testing::Test {
 protected:
  Credit open(std::uint64_t session = kSession, const std::string& station = "cam-1") {
    return check_.on_request(open_request(session, station), around_, model_.tool_length_mm);
  }
  Credit close(std::uint64_t session = kSession) {
    dds::SessionRequest request = open_request(session);
    request.request = dds::SessionRequestKind::kClose;
    return check_.on_request(request, around_, model_.tool_length_mm);
  }
  std::optional<Credit> send(const Batch& batch) {
    auto answer = check_.on_batch(batch, around_, accepted_);
    around_.free_slots -= accepted_.count;
    return answer;
  }
  /// A batch of `count` good blocks whose block `bad` is spoilt by `spoil`, CRC right.
  template <class Spoil>
  std::optional<Credit> send_spoilt(std::uint32_t count, std::uint32_t bad, Spoil spoil) {
    Batch batch = good_batch(kSession, check_.next_sequence(), count);
    spoil(batch.blocks[bad]);
    batch.crc = dds::batch_crc(batch);
    return send(batch);
  }

  MachineModel model_ = test::lai_machine();
  IntakeCheck check_{model_, {{1, 80.0}}, 99};
  IntakeContext around_{.now_ns = 0, .free_slots = 100, .actions = {.is_there = true}};
  Accepted accepted_;
  std::uint64_t session_ = kSession;
};

}  // namespace meridian::stream
