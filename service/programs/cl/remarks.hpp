// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "service/programs/cl/cl_error.hpp"

namespace meridian::cl {

/// What a reader of the file should know although it is not refused: one remark for each key, with
/// the line of its first place and how many there are.
class Remarks {
 public:
  /// `message` is only called for the first of its key.
  template <class Message>
  void warn(std::string_view key, std::uint32_t line, Message&& message) {
    const auto at = std::find(keys_.begin(), keys_.end(), key);
    if (at != keys_.end()) {
      ++warnings_[static_cast<std::size_t>(at - keys_.begin())].count;
      return;
    }
    if (keys_.size() == kMaxKeys) return;
    keys_.emplace_back(key);
    warnings_.push_back({line, std::string(message()), 1});
  }

  [[nodiscard]] const std::vector<ClWarning>& warnings() const noexcept { return warnings_; }

 private:
  static constexpr std::size_t kMaxKeys = 100;

  std::vector<std::string> keys_;
  std::vector<ClWarning> warnings_;
};

}  // namespace meridian::cl
