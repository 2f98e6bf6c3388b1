// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <thread>

/// Threaded trials of the two ports, and twins of them that are wrong on purpose: a trial that a
/// broken twin passes would prove nothing.
namespace meridian::testing {

/// An item that shows tearing and mix-up: every word is the same number.
struct Item {
  std::array<std::uint64_t, 64> words{};
  Item() = default;
  explicit Item(std::uint64_t n) { words.fill(n); }
  [[nodiscard]] bool is_whole() const {
    for (const std::uint64_t w : words) {
      if (w != words.front()) return false;
    }
    return true;
  }
};

struct Trial {
  std::uint64_t items = 0;   ///< values that the reader looked at
  std::uint64_t faults = 0;  ///< of these: torn, lost, repeated or out of order
};

/// A trial that looks for the absence of faults goes on until it has seen so many values.
inline constexpr std::uint64_t kEnoughItems = 20000;

/// Sends the numbers 1.. through `ring` until enough went through; for `time` at most, or until a
/// fault shows if `until_fault`.
template <class Ring>
Trial try_ring(Ring& ring, std::chrono::milliseconds time, bool until_fault) {
  std::atomic<bool> is_over{false};
  std::thread producer([&] {
    for (std::uint64_t n = 1; !is_over.load(std::memory_order_relaxed);) {
      if (ring.try_push(Item{n})) {
        ++n;
      } else {
        std::this_thread::yield();
      }
    }
  });
  Trial trial;
  const auto end = std::chrono::steady_clock::now() + time;
  std::uint64_t expected = 1;
  Item item;
  while (std::chrono::steady_clock::now() < end &&
         (until_fault ? trial.faults == 0 : trial.items < kEnoughItems)) {
    if (!ring.try_pop(item)) {
      std::this_thread::yield();
      continue;
    }
    ++trial.items;
    if (!item.is_whole() || item.words.front() != expected) ++trial.faults;
    expected = item.words.front() + 1;
  }
  is_over = true;
  producer.join();
  return trial;
}

/// Stores rising numbers in `port` until enough was read; for `time` at most, or until a fault
/// shows if `until_fault`. A value must be whole, and newer than the one before where the port says
/// that it is new.
template <class Port>
Trial try_latest(Port& port, std::chrono::milliseconds time, bool until_fault) {
  std::atomic<bool> is_over{false};
  std::thread writer([&] {
    for (std::uint64_t n = 1; !is_over.load(std::memory_order_relaxed); ++n) {
      port.store(Item{n});
      if (n % 64 == 0) std::this_thread::yield();
    }
  });
  Trial trial;
  const auto end = std::chrono::steady_clock::now() + time;
  std::uint64_t newest = 0;
  Item item;
  while (std::chrono::steady_clock::now() < end &&
         (until_fault ? trial.faults == 0 : trial.items < kEnoughItems)) {
    const bool is_new = port.load(item);
    ++trial.items;
    const std::uint64_t n = item.words.front();
    if (!item.is_whole() || (is_new ? n <= newest : n != newest)) ++trial.faults;
    newest = n;
  }
  is_over = true;
  writer.join();
  return trial;
}

/// Copies in two halves and lets others run between: what a scheduler may do at any time, done
/// often enough that a trial on a loaded machine sees it.
template <class T>
void copy_slowly(T& to, const T& from) {
  constexpr std::size_t kHalf = sizeof(T) / 2;
  const auto* source = reinterpret_cast<const unsigned char*>(&from);
  auto* target = reinterpret_cast<unsigned char*>(&to);
  std::copy(source, source + kHalf, target);
  std::this_thread::yield();
  std::copy(source + kHalf, source + sizeof(T), target + kHalf);
}

/// SpscRing with the stores of the producer in the order that a relaxed store would allow: the
/// counter first, the slot after.
template <class T, std::size_t N>
class RingThatPublishesTooEarly {
 public:
  bool try_push(const T& item) {
    const std::size_t n = written_.load();
    if (n - read_.load() == N) return false;
    written_.store(n + 1);
    copy_slowly(slots_[n & (N - 1)], item);
    return true;
  }
  bool try_pop(T& item) {
    const std::size_t n = read_.load();
    if (written_.load() == n) return false;
    item = slots_[n & (N - 1)];
    read_.store(n + 1);
    return true;
  }

 private:
  std::atomic<std::size_t> written_{0}, read_{0};
  std::array<T, N> slots_{};
};

/// SpscRing with the consumer's counter stored before the slot was read.
template <class T, std::size_t N>
class RingThatFreesTooEarly {
 public:
  bool try_push(const T& item) {
    const std::size_t n = written_.load();
    if (n - read_.load() == N) return false;
    slots_[n & (N - 1)] = item;
    written_.store(n + 1);
    return true;
  }
  bool try_pop(T& item) {
    const std::size_t n = read_.load();
    if (written_.load() == n) return false;
    read_.store(n + 1);
    copy_slowly(item, slots_[n & (N - 1)]);
    return true;
  }

 private:
  std::atomic<std::size_t> written_{0}, read_{0};
  std::array<T, N> slots_{};
};

/// LatestValue with two slots: the writer comes round to the slot that is being read.
template <class T>
class LatestValueWithTwoSlots {
 public:
  void store(const T& value) {
    const std::uint32_t back = 1 - front_.load();
    slots_[back] = value;
    front_.store(back);
  }
  bool load(T& value) {
    copy_slowly(value, slots_[front_.load()]);
    const bool is_new = value.words.front() != seen_;
    seen_ = value.words.front();
    return is_new;
  }

 private:
  std::array<T, 2> slots_{};
  std::atomic<std::uint32_t> front_{0};
  std::uint64_t seen_ = 0;
};

}  // namespace meridian::testing
