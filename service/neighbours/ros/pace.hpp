// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace meridian::ros {

/// Which rows of many have a message: the first, and of every period the first one in it. The ends
/// of periods lie on multiples of it, so that topics of one pace have their messages together.
class Pace {
 public:
  /// 0: every row.
  explicit Pace(std::int64_t period_ns) noexcept : period_ns_(period_ns) {}

  [[nodiscard]] bool is_due(std::int64_t now_ns) noexcept {
    if (period_ns_ == 0) return true;
    const std::int64_t period = now_ns / period_ns_;
    const bool is_new = !has_begun_ || period != period_;  // other, where a clock began anew
    has_begun_ = true;
    period_ = period;
    return is_new;
  }

 private:
  std::int64_t period_ns_;
  std::int64_t period_ = 0;
  bool has_begun_ = false;
};

/// Of what is not of every row: 25 a second, as a film.
inline constexpr std::int64_t kScreenPeriod_ns = 40'000'000;

}  // namespace meridian::ros
