// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>

#include "meridian/cycle/histogram.hpp"

namespace meridian::soak {

/// Histograms of a run of unknown length, cut into slices of equal time: at most kSlices, which
/// become twice as long when they are used up. So any run has its first and its last quarter in
/// fixed memory. Proof: tests/unit/soak/run_budgets_test.cpp.
class TimeSlices {
 public:
  using Named = std::map<std::string, Histogram>;

  /// What was measured lately, until `at_s` of the run.
  void add(double at_s, const std::string& name, const Histogram& part) {
    while (at_s >= kSlices * width_s_) halve();
    slices_[static_cast<std::size_t>(at_s / width_s_)][name].merge(part);
  }

  /// Whole slices that lie inside the first, or the last, quarter of a run of `elapsed_s`.
  [[nodiscard]] Named first_quarter(double elapsed_s) const { return between(0, elapsed_s / 4); }
  [[nodiscard]] Named last_quarter(double elapsed_s) const {
    return between(elapsed_s * 3 / 4, elapsed_s);
  }

 private:
  static constexpr std::size_t kSlices = 32;

  void halve() {
    for (std::size_t i = 0; i < kSlices / 2; ++i) {
      Named both = std::move(slices_[2 * i]);
      for (const auto& [name, part] : slices_[2 * i + 1]) both[name].merge(part);
      slices_[2 * i + 1].clear();
      slices_[i] = std::move(both);
    }
    for (std::size_t i = kSlices / 2; i < kSlices; ++i) slices_[i].clear();
    width_s_ *= 2;
  }

  [[nodiscard]] Named between(double begin_s, double end_s) const {
    Named sum;
    for (std::size_t i = 0; i < kSlices; ++i) {
      const double from_s = static_cast<double>(i) * width_s_;
      if (from_s < begin_s || from_s + width_s_ > end_s) continue;
      for (const auto& [name, part] : slices_[i]) sum[name].merge(part);
    }
    return sum;
  }

  double width_s_ = 1;
  std::array<Named, kSlices> slices_;
};

}  // namespace meridian::soak
