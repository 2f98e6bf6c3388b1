// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "service/transport/convert/messages.hpp"

namespace meridian::interpolator {

/// Which enabling devices are pressed, by the heartbeat that each sends (topic `enabling`). The
/// receive thread beats, the cycle looks: that a device fell silent or was released holds the
/// machine, whatever other threads do. Where enabling is required the machine is held as long as no
/// device is pressed; else only a device that had begun, and went without saying so, holds it.
///
/// Memory order. A place is a device's writer and its newest heartbeat. Only beat() fills a place
/// (writer first, heartbeat with release); look() frees one by exchanging the very heartbeat that
/// it found too old for 0, so a heartbeat that comes meanwhile is never lost. `released_` counts
/// what beat() freed; look() compares. RT: look(), holds_back() in the cycle, wait-free. Proof:
/// tests/unit/daemon/enabling_watch_test.cpp.
class EnablingWatch {
 public:
  enum class Beat : std::uint8_t {
    kKnown,     ///< nothing changed
    kBegun,     ///< a device was pressed that was not
    kReleased,  ///< one was let go
    kLeft,      ///< one said that it leaves
    kNoRoom     ///< more devices than slots: this one does not count
  };

  /// Before any thread runs.
  void set_up(bool is_required, std::int64_t timeout_ns) noexcept {
    is_required_ = is_required;
    timeout_ns_ = timeout_ns;
  }
  [[nodiscard]] bool is_required() const noexcept { return is_required_; }

  /// Receive thread: a heartbeat of `source` came at `now_ns` (not 0).
  Beat beat(std::uint64_t source, dds::EnablingDevice device, std::int64_t now_ns) noexcept {
    Slot* slot = find(source);
    if (device == dds::EnablingDevice::kPressed) {
      if (slot != nullptr) {
        slot->newest_ns.store(now_ns, std::memory_order_release);
        return Beat::kKnown;
      }
      return begin(source, now_ns) ? Beat::kBegun : Beat::kNoRoom;
    }
    if (slot == nullptr) return Beat::kKnown;
    slot->newest_ns.store(0, std::memory_order_release);
    if (device == dds::EnablingDevice::kLeaves) return Beat::kLeft;
    released_.fetch_add(1, std::memory_order_release);
    return Beat::kReleased;
  }

  /// Cycle: once in each, before holds_back().
  void look(std::int64_t now_ns) noexcept {
    const std::uint32_t released = released_.load(std::memory_order_acquire);
    is_lost_ = released != released_seen_;
    released_seen_ = released;
    pressed_ = 0;
    for (Slot& slot : slots_) {
      std::int64_t newest_ns = slot.newest_ns.load(std::memory_order_acquire);
      if (newest_ns == 0) continue;
      if (now_ns - newest_ns <= timeout_ns_) {
        ++pressed_;
      } else if (slot.newest_ns.compare_exchange_strong(newest_ns, 0)) {
        lost_source_.store(slot.source.load(std::memory_order_relaxed), std::memory_order_relaxed);
        losses_.fetch_add(1, std::memory_order_release);
        is_lost_ = true;
      }
    }
    shown_.store(pressed_, std::memory_order_relaxed);
  }
  /// Cycle: whether motion must be held now.
  [[nodiscard]] bool holds_back() const noexcept {
    return is_lost_ || (is_required_ && pressed_ == 0);
  }

  /// Any thread: devices that were pressed when the cycle looked last.
  [[nodiscard]] int pressed() const noexcept { return shown_.load(std::memory_order_relaxed); }
  /// Any thread: how often a device fell silent, and which did last.
  [[nodiscard]] std::uint32_t losses() const noexcept {
    return losses_.load(std::memory_order_acquire);
  }
  [[nodiscard]] std::uint64_t lost_source() const noexcept {
    return lost_source_.load(std::memory_order_relaxed);
  }

 private:
  struct Slot {
    std::atomic<std::uint64_t> source{0};
    std::atomic<std::int64_t> newest_ns{0};  ///< 0: free
  };

  [[nodiscard]] Slot* find(std::uint64_t source) noexcept {
    for (Slot& slot : slots_) {
      if (slot.newest_ns.load(std::memory_order_relaxed) != 0 &&
          slot.source.load(std::memory_order_relaxed) == source) {
        return &slot;
      }
    }
    return nullptr;
  }
  [[nodiscard]] bool begin(std::uint64_t source, std::int64_t now_ns) noexcept {
    for (Slot& slot : slots_) {
      if (slot.newest_ns.load(std::memory_order_relaxed) != 0) continue;
      slot.source.store(source, std::memory_order_relaxed);
      slot.newest_ns.store(now_ns, std::memory_order_release);
      return true;
    }
    return false;
  }

  bool is_required_ = false;
  std::int64_t timeout_ns_ = 300'000'000;
  std::array<Slot, 8> slots_{};
  std::atomic<std::uint32_t> released_{0}, losses_{0};
  std::atomic<std::uint64_t> lost_source_{0};
  std::atomic<int> shown_{0};
  std::uint32_t released_seen_ = 0;  ///< the cycle's
  int pressed_ = 0;                  ///< the cycle's
  bool is_lost_ = false;             ///< the cycle's: in this period
};

}  // namespace meridian::interpolator
