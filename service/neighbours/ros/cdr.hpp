// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace meridian::ros {

/// A ROS 2 message as it stands on the wire and in files: CDR, little-endian, every number at a
/// multiple of its own size from the begin of the content. Fields are put in the order of the
/// message's definition. Proof: tests/unit/ros/cdr_test.cpp.
class Cdr {
 public:
  /// Begins a message anew.
  Cdr& begin() {
    bytes_.assign(kHead, sizeof kHead);
    return *this;
  }
  template <class Number>
  Cdr& put(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    const std::size_t past = (bytes_.size() - sizeof kHead) % sizeof value;
    if (past > 0) bytes_.append(sizeof value - past, '\0');
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes_.append(raw, sizeof value);
    return *this;
  }
  Cdr& put(bool value) { return put(static_cast<std::uint8_t>(value ? 1 : 0)); }
  Cdr& put(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.append(text).push_back('\0');
    return *this;
  }
  Cdr& put(const char* text) { return put(std::string_view(text)); }
  Cdr& put(const std::string& text) { return put(std::string_view(text)); }
  /// How many elements of a sequence follow.
  Cdr& put_count(std::size_t count) { return put(static_cast<std::uint32_t>(count)); }
  /// builtin_interfaces/Time; `time_ns` is not negative and below 2^31 s.
  Cdr& put_time(std::int64_t time_ns) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    return put(static_cast<std::int32_t>(time_ns / kSecond))
        .put(static_cast<std::uint32_t>(time_ns % kSecond));
  }
  /// std_msgs/Header.
  Cdr& put_header(std::int64_t time_ns, std::string_view frame) {
    return put_time(time_ns).put(frame);
  }
  [[nodiscard]] std::string_view bytes() const noexcept { return bytes_; }

 private:
  static constexpr char kHead[4] = {0, 1, 0, 0};  ///< CDR, little-endian, no options
  std::string bytes_{kHead, sizeof kHead};
};

}  // namespace meridian::ros
