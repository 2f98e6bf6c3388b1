// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace meridian::drive {

/// How long setpoints were held back on their way, without comparing two clocks: the least delay
/// that was seen, `arrival_ns` by the receiver's clock minus `due_ns` by the sender's, is what the
/// clocks are apart. Times in ns. Proof: tests/unit/drive_kit/setpoint_age_test.cpp.
class SetpointAge {
 public:
  /// Whether this setpoint came more than `longest_ns` later than the fastest one. While drives are
  /// off each setpoint is the measure of the next: hosts that were suspended count anew.
  [[nodiscard]] bool is_late(std::int64_t due_ns, std::int64_t arrival_ns, std::int64_t longest_ns,
                             bool are_drives_off) noexcept {
    const std::int64_t apart = arrival_ns - due_ns;
    if (!has_any_ || are_drives_off) {
      min_ = apart;
    } else {
      // The sender's clock may be slower: the measure follows by what two crystals differ.
      const std::int64_t drift = std::max<std::int64_t>(0, arrival_ns - last_ns_) / kDriftShare;
      min_ = std::min(apart, min_ + drift);
    }
    has_any_ = true;
    last_ns_ = arrival_ns;
    return apart - min_ > longest_ns;
  }

 private:
  static constexpr std::int64_t kDriftShare = 5000;  ///< 200 parts per million
  bool has_any_ = false;
  std::int64_t min_ = 0, last_ns_ = 0;
};

}  // namespace meridian::drive
