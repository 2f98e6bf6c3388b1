// SPDX-License-Identifier: Apache-2.0
#include "service/transport/cyclone/dds_log.hpp"

#include <dds/ddsrt/log.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>

#include "service/text/alike_lines.hpp"
#include "service/text/line_output.hpp"
#include "service/text/printable.hpp"

namespace meridian::dds {
namespace {

[[nodiscard]] std::int64_t steady_ns_now() noexcept {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Where lines go. It outlives every thread of the library.
struct Log {
  std::mutex mutex;
  LogLine line;
  text::AlikeLines alike;

  static Log& get() {
    static auto* const log = new Log();
    return *log;
  }
  void report(bool all) {
    for (const std::string& count : alike.counts(steady_ns_now(), all)) {
      line(LogWeight::kWarning, "DDS: " + count);
    }
  }
};

void take_line(void*, const dds_log_data_t* data) {
  std::string_view said(data->message, data->size);
  said.remove_prefix(std::min<std::size_t>(data->hdrsize, said.size()));
  while (!said.empty() && (said.back() == '\n' || said.back() == '\0')) said.remove_suffix(1);
  const LogWeight weight = (data->priority & (DDS_LC_FATAL | DDS_LC_ERROR)) != 0 ? LogWeight::kError
                           : (data->priority & DDS_LC_WARNING) != 0 ? LogWeight::kWarning
                                                                    : LogWeight::kInfo;
  Log& log = Log::get();
  const std::lock_guard lock(log.mutex);
  const std::string line = text::printable(said);
  if (log.line && log.alike.pass(line, steady_ns_now())) log.line(weight, "DDS: " + line);
}

}  // namespace

void set_log(LogLine line) {
  Log& log = Log::get();
  {
    const std::lock_guard lock(log.mutex);
    log.line = std::move(line);
  }
  dds_set_log_sink(&take_line, nullptr);
}

void log_to_stderr() {
  struct Output {
    text::LineOutput out{STDERR_FILENO};
    std::uint64_t lost = 0;
  };
  set_log([output = std::make_shared<Output>()](LogWeight, const std::string& line) {
    using Result = text::LineOutput::Result;
    if (output->lost > 0) {
      const std::string count = "DDS: " + std::to_string(output->lost) + " lines were lost here\n";
      if (output->out.try_write(count) == Result::kWritten) output->lost = 0;
    }
    if (output->out.try_write(line + "\n") != Result::kWritten) ++output->lost;
  });
}

void report_left_out(bool all) {
  Log& log = Log::get();
  const std::lock_guard lock(log.mutex);
  if (log.line) log.report(all);
}

}  // namespace meridian::dds
