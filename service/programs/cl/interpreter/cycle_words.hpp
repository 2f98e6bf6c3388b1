// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include "service/programs/cl/interpreter/feed.hpp"
#include "service/programs/cl/refusal.hpp"
#include "service/programs/cl/text/statement.hpp"

namespace meridian::cl {

/// The numbers and words of a CYCLE statement, sorted by keyword.
struct CycleWords {
  std::vector<double> positions;  ///< before any keyword
  std::vector<double> feed_to, depth, rapid_to, retract_to, return_to, clear, steps, sink;
  std::vector<double> first_peck, next_peck, times, back;
  double dwell_s = 0, dwell_revolutions = 0;
  bool returns_to_before = false;  ///< RTRCTO,AUTO
  std::vector<WrittenFeed> feeds;
  std::vector<std::string_view> modifiers;

  [[nodiscard]] bool has(std::string_view modifier) const {
    return std::any_of(modifiers.begin(), modifiers.end(),
                       [modifier](std::string_view m) { return is_word(m, modifier); });
  }
};

/// Sorts what stands behind the type of a CYCLE statement. Refuses keywords that nobody knows, and
/// those with too many numbers or none. Proof: tests/unit/cl/hole_test.cpp.
[[nodiscard]] Expected<CycleWords, Refusal> read_cycle_words(const Statement& s);

}  // namespace meridian::cl
