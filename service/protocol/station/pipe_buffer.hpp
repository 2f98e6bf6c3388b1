// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <streambuf>
#include <vector>

namespace meridian::stream {

/// A stream buffer over a file descriptor (a pipe, a terminal, a file) whose wait for bytes can be
/// cut short from another thread. It hands out what one read() gives, so that what a slow writer
/// has written is there at once. It does not own the descriptor.
///
/// One thread reads; stop() may come from any. Proof: tests/unit/protocol/source_pump_test.cpp.
class PipeBuffer : public std::streambuf {
 public:
  /// Throws std::system_error where the process is out of descriptors.
  explicit PipeBuffer(int descriptor);
  ~PipeBuffer() override;
  PipeBuffer(const PipeBuffer&) = delete;
  PipeBuffer& operator=(const PipeBuffer&) = delete;

  /// Ends the stream for its reader, who may be waiting: it sees the end of the input.
  void stop() noexcept;

 protected:
  /// Throws std::system_error where the medium fails, as a file buffer does.
  int_type underflow() override;

 private:
  /// False where stop() came first.
  [[nodiscard]] bool wait_for_bytes() const;

  int descriptor_;
  int stop_ = -1;  ///< eventfd: readable once stop() was called
  std::vector<char> buffer_;
};

}  // namespace meridian::stream
