// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"

namespace meridian::dds {

/// Sleeps until one of its readers has data, wake() is called or time is up. One thread waits; any
/// thread wakes.
class Waitset {
 public:
  explicit Waitset(Participant& participant);  ///< Throws DdsError.
  ~Waitset();
  Waitset(const Waitset&) = delete;
  Waitset& operator=(const Waitset&) = delete;

  template <class Message>
  void attach(Reader<Message>& reader) {
    attach_reader(reader.handle());
  }
  /// Returns at once if data is waiting or wake() was called since the last wait.
  void wait(std::chrono::nanoseconds timeout) noexcept;
  void wake() noexcept;

 private:
  void attach_reader(std::int32_t reader);
  std::int32_t waitset_ = 0, guard_ = 0;
};

}  // namespace meridian::dds
