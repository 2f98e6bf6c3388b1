// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "service/transport/participant.hpp"

namespace meridian::dds {

/// Where a sample came from.
struct SampleInfo {
  bool is_valid = false;     ///< false: only `is_alive` changed, the message holds the key
  bool is_alive = false;     ///< false: disposed, or nobody writes this instance any more
  std::uint64_t source = 0;  ///< writer that sent it, see Reader::has_source
};

/// How a reader gets what a reliable topic carries.
enum class Delivery : std::uint8_t {
  kOfTopic,
  /// Best effort and volatile: what was lost on the way is not waited for. For who shows what a
  /// service repeats many times a second: what comes next never waits for what is over.
  kNewest
};

/// Receives `Message` on its topic with the topic's QoS (topics.cpp). One thread takes at a time.
template <class Message>
class Reader {
 public:
  /// Throws DdsError. `on_data`, if given, is called on Cyclone's receive thread whenever samples
  /// arrive; it must not block, and may call take() if no other thread does. For cyclic topics: a
  /// sample that arrives while the reader is being created is only seen with the next one. `depth`
  /// samples of an instance wait to be taken, 0: as many as the topic says. Where the topic says
  /// one, of two who write the same instance only the later is seen.
  explicit Reader(Participant& participant, std::function<void(Reader&)> on_data = {},
                  int depth = 0, Delivery delivery = Delivery::kOfTopic);
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

}  // namespace meridian::dds
