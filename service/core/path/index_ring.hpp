// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace meridian {

/// A queue whose elements keep their index for life: the first ever added is 0, whatever was
/// dropped since. Fixed capacity, allocated once.
template <class T>
class IndexRing {
 public:
  /// `capacity` is a power of two.
  explicit IndexRing(std::size_t capacity) : items_(capacity), mask_(capacity - 1) {}

  void clear() noexcept { begin_ = end_ = 0; }
  [[nodiscard]] std::int64_t begin_index() const noexcept { return begin_; }
  [[nodiscard]] std::int64_t end_index() const noexcept { return end_; }
  [[nodiscard]] bool is_full() const noexcept {
    return end_ - begin_ >= static_cast<std::int64_t>(items_.size());
  }
  [[nodiscard]] T& operator[](std::int64_t i) noexcept {
    return items_[static_cast<std::size_t>(i) & mask_];
  }
  [[nodiscard]] const T& operator[](std::int64_t i) const noexcept {
    return items_[static_cast<std::size_t>(i) & mask_];
  }
  [[nodiscard]] T& back() noexcept { return (*this)[end_ - 1]; }
  [[nodiscard]] const T& back() const noexcept { return (*this)[end_ - 1]; }

  void push(const T& item) noexcept { (*this)[end_++] = item; }
  /// Where it is full the oldest element goes.
  void push_over_oldest(const T& item) noexcept {
    if (is_full()) ++begin_;
    push(item);
  }
  void drop_last() noexcept { --end_; }
  /// Takes the oldest element; false if there is none.
  [[nodiscard]] bool take_oldest(T& out) noexcept {
    if (begin_ == end_) return false;
    out = (*this)[begin_++];
    return true;
  }
  /// Drops every element before index `first`.
  void drop_before(std::int64_t first) noexcept {
    if (first > begin_) begin_ = first < end_ ? first : end_;
  }

 private:
  std::vector<T> items_;
  std::size_t mask_;
  std::int64_t begin_ = 0, end_ = 0;
};

}  // namespace meridian
