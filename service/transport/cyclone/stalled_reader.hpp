// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "service/transport/participant.hpp"

/// Who does not acknowledge what reliable writers send. Writers never wait for such a reader: the
/// samples that it has not taken by then pass it by. DDS has no interface for the question; Cyclone
/// 0.10 keeps the answer with each writer. Proof: tests/unit/transport/stalled_reader_test.cpp.
namespace meridian::dds {

/// A reader that has not acknowledged all that a writer sent.
struct Unacknowledged {
  std::uint64_t up_to = 0;  ///< sequence that all have acknowledged
  std::uint64_t sent = 0;   ///< sequence of the newest sample
  std::string who;          ///< where its participant runs, or its GUID
};

/// Nothing where all readers of `writer` (Writer::handle()) have acknowledged everything.
[[nodiscard]] std::optional<Unacknowledged> find_unacknowledged(const Participant& participant,
                                                                std::int32_t writer);

/// How long one reader of one writer has stayed where it is. Readers that come and go, each behind
/// for a moment where the last one was, are several readers: none of them stalls.
class StallWatch {
 public:
  /// Whether the reader that is `behind` now has been so, without a step on, for 2 s.
  [[nodiscard]] bool look(const std::optional<Unacknowledged>& unacknowledged, std::int64_t now_ns);

 private:
  std::optional<Unacknowledged> first_;  ///< as it was when it was seen there first
  std::int64_t since_ns_ = 0;            ///< of `first_`
};

/// Finds readers that stay behind for 2 s. Time is an argument; one thread.
class StalledReaders {
 public:
  explicit StalledReaders(const Participant& participant) : participant_(participant) {}

  /// `topic`: for the message.
  void watch(std::int32_t writer, std::string topic) {
    writers_.push_back({writer, std::move(topic), {}});
  }
  /// To be called about once a second: who stalls, with the topic; empty: nobody.
  [[nodiscard]] std::string look(std::int64_t now_ns);

 private:
  struct Watched {
    std::int32_t writer;
    std::string topic;
    StallWatch watch;
  };
  const Participant& participant_;
  std::vector<Watched> writers_;
};

}  // namespace meridian::dds
