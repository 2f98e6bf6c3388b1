// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "meridian/monitoring/monitored.hpp"

namespace meridian::monitoring {

/// The newest 256 setpoints by their cycles: a report names the one that the drives took. RT:
/// cycle.
class SentPositions {
 public:
  void put(std::uint64_t cycle, const Values& commanded) noexcept {
    sent_[cycle % kCapacity] = {cycle, commanded};
  }
  /// nullptr: none was sent in that cycle, or long ago.
  [[nodiscard]] const Values* find(std::uint64_t cycle) const noexcept {
    const Sent& sent = sent_[cycle % kCapacity];
    return cycle != 0 && sent.cycle == cycle ? &sent.commanded : nullptr;
  }

 private:
  static constexpr std::size_t kCapacity = 256;
  struct Sent {
    std::uint64_t cycle = 0;
    Values commanded{};
  };
  std::array<Sent, kCapacity> sent_{};
};

}  // namespace meridian::monitoring
