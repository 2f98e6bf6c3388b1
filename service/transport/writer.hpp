// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "service/transport/participant.hpp"

namespace meridian::dds {

/// Sends `Message` on its topic with the topic's QoS (topics.cpp). One thread writes at a time.
template <class Message>
class Writer {
 public:
  explicit Writer(Participant& participant);  ///< Throws DdsError.
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Registers the message's instance, so that later writes of it make no heap call.
  void register_instance(const Message& message) noexcept;
  /// False: not sent; reliable topics with a full history blocked for their max blocking time.
  [[nodiscard]] bool write(const Message& message) noexcept;
  [[nodiscard]] int matched_readers() const noexcept;
  [[nodiscard]] std::int32_t handle() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meridian::dds
