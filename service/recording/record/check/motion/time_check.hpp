// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "service/recording/record/check/check.hpp"

namespace meridian::record {

/// Checks how long blocks in inverse time take: no less than they ask for, at the highest override.
/// Where the tool is on its path is known to some tolerances, so each is checked on its inner part.
/// Units: mm, s. Proof: tests/unit/record/time_check_test.cpp, check_inverse_time_test.cpp.
class TimeCheck {
 public:
  /// `tolerance_mm`: of a matched place on the way, tip and axis together.
  TimeCheck(const CheckedPath& path, double tolerance_mm, double period_s,
            const CheckOptions& options);

  /// The farthest point on the way that was matched, and the one that is surely passed; cycles go
  /// up.
  void add(double matched, double passed, std::uint64_t cycle);
  void finish(CheckReport& report) const;

 private:
  /// The block that ends with `last`.
  void check(const PathElement& last, std::uint64_t begin, std::uint64_t end);

  const CheckedPath& path_;
  double tolerance_, period_, factor_;
  std::vector<std::uint64_t> entered_;  ///< cycle in which an element's inner part was reached
  std::size_t left_ = 0;                ///< elements whose inner part is behind the tool
  std::size_t first_ = 0;               ///< first element of the block that is being left
  double passed_ = 0;                   ///< of its elements that were left
  Finding worst_;
  double worst_share_ = 1;
};

}  // namespace meridian::record
