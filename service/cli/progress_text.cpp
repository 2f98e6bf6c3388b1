// SPDX-License-Identifier: Apache-2.0
#include "service/cli/progress_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace meridian::cli {

std::string time_text(double seconds) {
  const auto whole = static_cast<long long>(std::max(0.0, std::ceil(seconds)));
  std::array<char, 48> buffer{};
  if (whole >= 3600) {
    std::snprintf(buffer.data(), buffer.size(), "%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60,
                  whole % 60);
  } else {
    std::snprintf(buffer.data(), buffer.size(), "%lld:%02lld", whole / 60, whole % 60);
  }
  return buffer.data();
}

std::string progress_text(const stream::ProgressView& view) {
  std::array<char, 160> buffer{};
  std::string text = "block " + std::to_string(view.block);
  if (view.block_count > 0) text += " of " + std::to_string(view.block_count);
  if (view.is_rapid) {
    std::snprintf(buffer.data(), buffer.size(), ", line %u, rapid at %.0f mm/min", view.line,
                  view.feed_achieved_mm_per_min);
  } else {
    std::snprintf(buffer.data(), buffer.size(), ", line %u, feed %.0f of %.0f mm/min", view.line,
                  view.feed_achieved_mm_per_min, view.feed_programmed_mm_per_min);
  }
  text += buffer.data();
  if (view.to_go_s) text += ", to go " + time_text(*view.to_go_s);
  return text;
}

void ProgressPrinter::say(const std::string& text) {
  wipe();
  std::printf("%s\n", text.c_str());
  std::fflush(stdout);
}

void ProgressPrinter::show(const stream::ProgressView& view) {
  constexpr std::chrono::milliseconds kBarEvery{100}, kLineEvery{2000};
  const auto now = std::chrono::steady_clock::now();
  if (now - printed_ < (is_terminal_ ? kBarEvery : kLineEvery)) return;
  const std::string text = progress_text(view);
  if (text == shown_) return;
  shown_ = text;
  printed_ = now;
  if (!is_terminal_) {
    std::printf("%3.0f %% %s\n", view.fraction * 100, text.c_str());
  } else {
    constexpr int kWidth = 24;
    const int full = static_cast<int>(std::lround(view.fraction * kWidth));
    std::string bar(static_cast<std::size_t>(std::clamp(full, 0, kWidth)), '#');
    bar.resize(kWidth, '.');
    std::printf("\r\033[K[%s] %3.0f %% %s", bar.c_str(), view.fraction * 100, text.c_str());
    has_bar_ = true;
  }
  std::fflush(stdout);
}

void ProgressPrinter::wipe() {
  if (has_bar_) std::printf("\r\033[K");
  has_bar_ = false;
}

void ProgressPrinter::end() {
  if (has_bar_) std::printf("\n");
  has_bar_ = false;
  std::fflush(stdout);
}

}  // namespace meridian::cli
