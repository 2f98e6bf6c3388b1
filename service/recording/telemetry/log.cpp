// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/log.hpp"

#include <fcntl.h>
#include <spdlog/async.h>
#include <spdlog/details/thread_pool.h>
#include <spdlog/sinks/base_sink.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <functional>
#include <mutex>
#include <string>

#include "service/text/line_output.hpp"
#include "service/text/printable.hpp"
#include "service/transport/cyclone/dds_log.hpp"

namespace meridian::telemetry {
namespace {

using Clock = std::chrono::steady_clock;

/// When the log's thread waits for a reader no longer; never as long as the service runs.
std::atomic<Clock::time_point> wait_until{Clock::time_point::max()};

/// Writes a line whose control characters are escaped, and waits where nobody reads; meanwhile the
/// oldest lines of the queue give way, and the next that is written says how many. One thread.
class LineSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit LineSink(int descriptor) : output_(descriptor) {}
  void count_lost_of(spdlog::details::thread_pool& pool) {
    overrun_ = [&pool] { return pool.overrun_counter(); };
  }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t formatted;
    formatter_->format(message, formatted);
    std::string_view text(formatted.data(), formatted.size());
    while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
    if (!write(text::printable(text) + "\n")) ++not_written_;
    const std::uint64_t lost = not_written_ + (overrun_ ? overrun_() : 0);
    if (lost > reported_ &&
        write(std::to_string(lost - reported_) + " lines of the log were lost here\n")) {
      reported_ = lost;
    }
  }
  void flush_() override {}

 private:
  [[nodiscard]] bool write(const std::string& line) {
    using Result = text::LineOutput::Result;
    for (;;) {
      const Result result = output_.try_write(line);
      if (result != Result::kNoRoom) return result == Result::kWritten;
      if (Clock::now() >= wait_until.load()) return false;
      output_.wait(std::chrono::milliseconds(50));
    }
  }

  text::LineOutput output_;
  std::function<std::uint64_t()> overrun_;
  std::uint64_t not_written_ = 0, reported_ = 0;
};

/// No pipe without a reader is waited for.
[[nodiscard]] int open_log(const std::filesystem::path& file) {
  constexpr int kFlags = O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
  const int descriptor = ::open(file.c_str(), kFlags, 0644);
  if (descriptor < 0) {
    throw spdlog::spdlog_ex("the log " + file.string() + " cannot be opened", errno);
  }
  return descriptor;
}

}  // namespace

std::shared_ptr<spdlog::logger> make_log(const std::filesystem::path& file) {
  constexpr std::size_t kQueuedLines = 1024;
  spdlog::init_thread_pool(kQueuedLines, 1);
  const auto sink = std::make_shared<LineSink>(file.empty() ? STDERR_FILENO : open_log(file));
  sink->count_lost_of(*spdlog::thread_pool());
  auto log = std::make_shared<spdlog::async_logger>("meridiand", sink, spdlog::thread_pool(),
                                                    spdlog::async_overflow_policy::overrun_oldest);
  log->set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
  dds::set_log([log](dds::LogWeight weight, const std::string& line) {
    log->log(weight == dds::LogWeight::kInfo      ? spdlog::level::info
             : weight == dds::LogWeight::kWarning ? spdlog::level::warn
                                                  : spdlog::level::err,
             "{}", line);
  });
  return log;
}

void end_log(std::chrono::milliseconds patience) {
  dds::set_log({});
  wait_until = Clock::now() + patience;
  spdlog::shutdown();
}

}  // namespace meridian::telemetry
