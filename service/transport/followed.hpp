// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "service/transport/reader.hpp"

namespace meridian::dds {

/// Takes what came on a topic that is keyed by its service, for a receiver that wants one service,
/// whoever it is: it follows the one that it heard first for as long as that is there and speaks,
/// then another one. No clocks are compared, for two hosts have two: one that says nothing while
/// another speaks ten times is gone, though its lease may last. Proof:
/// tests/unit/transport/exchange_test.cpp.
template <class Message>
class Followed {
 public:
  /// Takes everything that came since the last call and leaves the newest of the service that is
  /// followed in `message`; false where nothing of it came.
  [[nodiscard]] bool take(Reader<Message>& reader, Message& message) {
    return take(reader, message, [](const Message&, std::uint64_t) {});
  }
  /// The same; `on_sample` sees every sample, of others too, with its writer.
  template <class OnSample>
  [[nodiscard]] bool take(Reader<Message>& reader, Message& message, OnSample on_sample) {
    bool has_message = false;
    bool is_there = source_ != 0 && reader.has_source(source_);
    Message taken;
    SampleInfo info;
    while (reader.take(taken, info)) {
      if (!info.is_valid) continue;
      on_sample(taken, info.source);
      const bool is_other = info.source != source_;
      if (is_there && is_other && ++others_ < kSilent) continue;
      others_ = 0;
      source_ = info.source;
      is_there = reader.has_source(source_);
      message = taken;
      has_message = true;
    }
    return has_message;
  }
  /// Writer of the service that is followed, see SampleInfo; 0: none yet.
  [[nodiscard]] std::uint64_t source() const noexcept { return source_; }

 private:
  static constexpr int kSilent = 10;  ///< samples of others in a row
  int others_ = 0;
  std::uint64_t source_ = 0;
};

}  // namespace meridian::dds
