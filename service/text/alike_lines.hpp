// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meridian::text {

/// Keeps lines that are alike but for their numbers from flooding a log: of each kind so many pass
/// in a while, the others are counted. Time is an argument. One thread.
/// Proof: tests/unit/text/alike_lines_test.cpp.
class AlikeLines {
 public:
  static constexpr std::uint64_t kPassing = 5;
  static constexpr std::int64_t kWhile_ns = 10'000'000'000;

  /// Whether `line` is to be written.
  [[nodiscard]] bool pass(std::string_view line, std::int64_t now_ns);
  /// What was left out of kinds whose while is over, a line each; with `all` of every kind.
  [[nodiscard]] std::vector<std::string> counts(std::int64_t now_ns, bool all = false);

 private:
  struct Kind {
    std::uint64_t hash = 0;
    std::int64_t since_ns = 0;
    std::uint64_t seen = 0;  ///< in this while; 0: the place is free
    std::string first;
  };
  [[nodiscard]] Kind& kind_of(std::string_view line, std::int64_t now_ns);

  std::array<Kind, 32> kinds_;
  std::vector<std::string> counted_;  ///< of kinds that gave way to others
};

}  // namespace meridian::text
