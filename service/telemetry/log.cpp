// SPDX-License-Identifier: Apache-2.0
#include "service/telemetry/log.hpp"

#include <spdlog/async.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>

namespace meridian::telemetry {

std::shared_ptr<spdlog::logger> make_log(const std::filesystem::path& file) {
  constexpr std::size_t kQueuedLines = 1024;
  spdlog::init_thread_pool(kQueuedLines, 1);
  spdlog::sink_ptr sink;
  if (file.empty()) {
    sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  } else {
    sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string());
  }
  auto log =
      std::make_shared<spdlog::async_logger>("meridiand", std::move(sink), spdlog::thread_pool(),
                                             spdlog::async_overflow_policy::overrun_oldest);
  log->set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
  log->flush_on(spdlog::level::warn);
  return log;
}

}  // namespace meridian::telemetry
