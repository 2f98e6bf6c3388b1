// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

/// What was announced when, on the machine's clock, for who checks it later. Both forget what no
/// later question can ask for. Proof: tests/unit/soak/soak_test.cpp.
namespace meridian::soak {

/// The operator's feed overrides.
class AskedOverrides {
 public:
  void announce(double factor, std::int64_t now_ns) { asked_.push_back({factor, now_ns}); }

  /// Highest override in force at `time_ns` or later, at least 1.
  [[nodiscard]] double max_since(std::int64_t time_ns) const {
    double before = 1, max = 1;
    for (const Asked& asked : asked_) {
      if (asked.since_ns <= time_ns) {
        before = asked.factor;
      } else {
        max = std::max(max, asked.factor);
      }
    }
    return std::max(before, max);
  }

  /// Nobody asks for what was before `time_ns` any more.
  void forget_before(std::int64_t time_ns) {
    std::size_t past = 0;
    while (past + 1 < asked_.size() && asked_[past + 1].since_ns <= time_ns) ++past;
    asked_.erase(asked_.begin(), asked_.begin() + static_cast<std::ptrdiff_t>(past));
  }

 private:
  struct Asked {
    double factor = 1;
    std::int64_t since_ns = 0;
  };
  std::vector<Asked> asked_;
};

/// The programs that were sent, one after the other.
class SentPrograms {
 public:
  /// `is_ours`: the file was made for this one time, to be removed when it is forgotten.
  void announce(std::string file, bool is_ours, std::int64_t now_ns) {
    sent_.push_back({std::move(file), is_ours, now_ns});
  }

  /// File of the program that was under way at `time_ns`; empty where none was.
  [[nodiscard]] std::string at(std::int64_t time_ns) const {
    std::string file;
    for (const Sent& sent : sent_) {
      if (sent.since_ns <= time_ns) file = sent.file;
    }
    return file;
  }

  /// Nobody asks for what was before `time_ns` any more.
  void forget_before(std::int64_t time_ns) {
    std::size_t past = 0;
    for (; past + 1 < sent_.size() && sent_[past + 1].since_ns <= time_ns; ++past) {
      std::error_code ignored;
      if (sent_[past].is_ours) std::filesystem::remove(sent_[past].file, ignored);
    }
    sent_.erase(sent_.begin(), sent_.begin() + static_cast<std::ptrdiff_t>(past));
  }

 private:
  struct Sent {
    std::string file;
    bool is_ours = false;
    std::int64_t since_ns = 0;
  };
  std::vector<Sent> sent_;
};

}  // namespace meridian::soak
