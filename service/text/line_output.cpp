// SPDX-License-Identifier: Apache-2.0
#include "service/text/line_output.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <string>

namespace meridian::text {

LineOutput::LineOutput(int descriptor) noexcept : file_(descriptor) {
  struct stat facts {};
  if (::fstat(descriptor, &facts) != 0 || S_ISREG(facts.st_mode)) return;
  kind_ = S_ISSOCK(facts.st_mode) ? Kind::kSocket : Kind::kPipe;
  if (kind_ == Kind::kSocket) return;
  const std::string name = "/proc/self/fd/" + std::to_string(descriptor);
  const int own = ::open(name.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (own < 0) return;
  file_ = own;
  is_own_ = true;
}

LineOutput::~LineOutput() {
  if (is_own_) (void)::close(file_);
}

/// How many bytes were written; -1: none can be now.
long LineOutput::put(std::string_view bytes) const noexcept {
  if (kind_ == Kind::kSocket) {
    return ::send(file_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  }
  if (kind_ == Kind::kPipe && !is_own_) {
    // As much as a pipe with room takes at once.
    pollfd room{.fd = file_, .events = POLLOUT, .revents = 0};
    if (::poll(&room, 1, 0) != 1 || (room.revents & POLLOUT) == 0) {
      errno = EAGAIN;
      return -1;
    }
    bytes = bytes.substr(0, PIPE_BUF);
  }
  return ::write(file_, bytes.data(), bytes.size());
}

LineOutput::Result LineOutput::try_write(std::string_view line) noexcept {
  const auto why = [] {
    return errno == EAGAIN || errno == EWOULDBLOCK ? Result::kNoRoom : Result::kFailed;
  };
  while (!rest_.empty()) {
    const long count = put(rest_);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return why();
    rest_.erase(0, static_cast<std::size_t>(count));
  }
  for (bool is_begun = false; !line.empty();) {
    const long count = put(line);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0 && !is_begun) return why();
    if (count <= 0) {
      rest_ = line;
      break;
    }
    is_begun = true;
    line.remove_prefix(std::min(line.size(), static_cast<std::size_t>(count)));
  }
  return Result::kWritten;
}

void LineOutput::wait(std::chrono::milliseconds patience) const noexcept {
  pollfd room{.fd = file_, .events = POLLOUT, .revents = 0};
  (void)::poll(&room, 1, static_cast<int>(patience.count()));
}

}  // namespace meridian::text
