// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "service/dds/participant.hpp"

namespace meridian::dds {

/// Where a sample came from.
struct SampleInfo {
  bool is_valid = false;     ///< false: only `is_alive` changed, the message holds the key
  bool is_alive = false;     ///< false: disposed, or nobody writes this instance any more
  std::uint64_t source = 0;  ///< writer that sent it, see Reader::has_source
  std::int64_t sent_ns = 0;  ///< writer's system clock, since 1970
};

/// Receives `Message` on its topic with the topic's QoS (topics.cpp). One thread takes at a time.
template <class Message>
class Reader {
 public:
  /// Throws DdsError. `on_data`, if given, is called on Cyclone's receive thread whenever samples
  /// arrive; it must not block, and may call take() if no other thread does. For cyclic topics: a
  /// sample that arrives while the reader is being created is only seen with the next one.
  explicit Reader(Participant& participant, std::function<void(Reader&)> on_data = {});
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// Takes the next sample; false when there is none. Makes no heap call where the message has no
  /// strings and at most 256 bytes.
  [[nodiscard]] bool take(Message& message, SampleInfo& info) noexcept;
  [[nodiscard]] bool take(Message& message) noexcept;  ///< skips samples without data

  [[nodiscard]] int matched_writers() const noexcept;
  /// Whether the writer behind SampleInfo::source is still matched.
  [[nodiscard]] bool has_source(std::uint64_t source) const noexcept;
  [[nodiscard]] std::int32_t handle() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Takes everything that came and leaves what was sent last in `message`; false where nothing came.
/// For topics that are keyed by their service and whose receiver wants the newest whoever it is
/// from: instances come in any order.
template <class Message>
[[nodiscard]] bool take_newest(Reader<Message>& reader, Message& message) {
  bool has_message = false;
  std::int64_t newest_ns = 0;
  Message taken;
  SampleInfo info;
  while (reader.take(taken, info)) {
    if (!info.is_valid || (has_message && info.sent_ns < newest_ns)) continue;
    newest_ns = info.sent_ns;
    message = taken;
    has_message = true;
  }
  return has_message;
}

}  // namespace meridian::dds
