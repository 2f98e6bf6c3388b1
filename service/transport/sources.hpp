// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "service/transport/participant.hpp"

/// Who is behind SampleInfo::source. Proof: tests/unit/transport/sources_test.cpp.
namespace meridian::dds {

/// The participant that owns a writer matched to `reader`, as a number made of its GUID: the same
/// for all writers of that participant, and the same again after a network that was cut. 0: the
/// writer is not matched any more. Makes heap calls.
[[nodiscard]] std::uint64_t participant_of(std::int32_t reader, std::uint64_t source) noexcept;

/// The same number of a participant of this process.
[[nodiscard]] std::uint64_t number_of(const Participant& participant) noexcept;

/// participant_of(), remembered for the sources that were asked for last. One thread.
class Senders {
 public:
  [[nodiscard]] std::uint64_t participant_of(std::int32_t reader, std::uint64_t source) noexcept;

 private:
  struct Known {
    std::uint64_t source = 0, participant = 0;
  };
  std::array<Known, 128> known_{};
  std::size_t at_ = 0;
};

/// In words, where it runs: "process 4711 on host mill3"; its GUID where its vendor does not say.
[[nodiscard]] std::string describe_source(const Participant& participant, std::int32_t reader,
                                          std::uint64_t source);

/// The same for the participant with that GUID, 16 bytes as on the wire.
[[nodiscard]] std::string describe_participant(const Participant& participant,
                                               const std::uint8_t* guid);

/// Where everybody else runs who has a writer on `topic`, in words, five at most and how many more;
/// "nobody". For reports: makes heap calls and a reader.
[[nodiscard]] std::string describe_writers(const Participant& participant, const char* topic);

}  // namespace meridian::dds
