// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/line_reporter.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace meridian::drive {

LineReporter::LineReporter(Print print) : print_(std::move(print)) {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    constexpr auto kBetweenLooks = std::chrono::milliseconds(10);
    while (!stop.stop_requested()) {
      print_waiting();
      std::this_thread::sleep_for(kBetweenLooks);
    }
    print_waiting();
  });
}

LineReporter::~LineReporter() = default;

void LineReporter::write_line(std::string_view text) noexcept {
  Line line;
  line.length = static_cast<std::uint32_t>(std::min(text.size(), kMaxBytes));
  std::copy_n(text.begin(), line.length, line.text.begin());
  if (!lines_.try_push(line)) lost_.fetch_add(1, std::memory_order_relaxed);
}

void LineReporter::print_waiting() {
  for (Line line; lines_.try_pop(line);) print_({line.text.data(), line.length});
  const std::uint64_t lost = lost_.load(std::memory_order_relaxed);
  const std::uint64_t news = lost - std::exchange(lost_reported_, lost);
  if (news > 0) print_(std::to_string(news) + " lines lost: nobody took them in time");
}

}  // namespace meridian::drive
