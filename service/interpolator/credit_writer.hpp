// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

#include "service/dds/messages.hpp"
#include "service/dds/writer.hpp"

namespace meridian::interpolator {

/// Sends credits. Each session is an instance of its own, and Cyclone keeps the end of one until
/// every reader has acknowledged it: beside a reader that never does, memory would grow with every
/// session that anybody opens. Where too much is unacknowledged the writer is replaced by a new
/// one; readers that hang lose it, the others hear the next repetition of the credit. One thread
/// writes. Proof: tests/unit/interpolator/credit_writer_test.cpp.
class CreditWriter {
 public:
  /// How many samples of the writer with this handle a reader has not acknowledged.
  using Unacknowledged = std::function<std::uint64_t(std::int32_t)>;

  static constexpr std::uint64_t kMaxUnacknowledged = 1024;
  static constexpr int kEndsBetweenLooks = 256;

  explicit CreditWriter(dds::Participant& participant);
  CreditWriter(dds::Participant& participant, Unacknowledged unacknowledged);

  void write(const dds::Credit& credit) noexcept { (void)writer_->write(credit); }
  /// The session is over, and its last verdict need not be kept any more.
  void end(const dds::Credit& credit);
  /// Any thread: of the writer in use, see dds::StalledReaders.
  [[nodiscard]] std::int32_t handle() const noexcept {
    return handle_.load(std::memory_order_relaxed);
  }

 private:
  void replace();

  dds::Participant& participant_;
  Unacknowledged unacknowledged_;
  std::unique_ptr<dds::Writer<dds::Credit>> writer_;
  std::atomic<std::int32_t> handle_;
  int ends_ = 0;  ///< since it was looked at last
  std::jthread closing_;  ///< of the writer before: Cyclone may wait there for a reader that hangs
};

}  // namespace meridian::interpolator
