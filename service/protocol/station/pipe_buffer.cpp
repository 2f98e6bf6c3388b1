// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/station/pipe_buffer.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <system_error>

namespace meridian::stream {

namespace {

constexpr std::size_t kBytes = 64 * 1024;

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

PipeBuffer::PipeBuffer(int descriptor)
    : descriptor_(descriptor), stop_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)), buffer_(kBytes) {
  if (stop_ < 0) fail("eventfd");
}

PipeBuffer::~PipeBuffer() { ::close(stop_); }

void PipeBuffer::stop() noexcept {
  const std::uint64_t one = 1;
  static_cast<void>(::write(stop_, &one, sizeof one) == sizeof one);
}

bool PipeBuffer::wait_for_bytes() const {
  std::array<pollfd, 2> wanted{pollfd{stop_, POLLIN, 0}, pollfd{descriptor_, POLLIN, 0}};
  while (::poll(wanted.data(), wanted.size(), -1) < 0) {
    if (errno != EINTR) fail("poll");
  }
  return wanted[0].revents == 0;
}

PipeBuffer::int_type PipeBuffer::underflow() {
  if (gptr() != egptr()) return traits_type::to_int_type(*gptr());
  for (;;) {
    if (!wait_for_bytes()) return traits_type::eof();
    const ssize_t got = ::read(descriptor_, buffer_.data(), buffer_.size());
    if (got == 0) return traits_type::eof();
    if (got < 0 && errno != EINTR && errno != EAGAIN) fail("read");
    if (got <= 0) continue;
    setg(buffer_.data(), buffer_.data(), buffer_.data() + got);
    return traits_type::to_int_type(*gptr());
  }
}

}  // namespace meridian::stream
