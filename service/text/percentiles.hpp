// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "meridian/cycle/histogram.hpp"

namespace meridian::text {

/// A histogram as the percentile table of HdrHistogram, which its plotters read: value (µs),
/// percentile, count up to there, 1 / (1 - percentile), five steps for every halving of what is
/// left, then mean, deviation, maximum and total. Source: HdrHistogram,
/// AbstractHistogram.outputPercentileDistribution. Proof:
/// tests/unit/probe/percentile_table_test.cpp.
[[nodiscard]] std::string percentile_table(const Histogram& histogram);

/// "wake-up lateness" as the name of a file: "wake-up-lateness.hgrm".
[[nodiscard]] std::string percentile_file_name(const std::string& name);

}  // namespace meridian::text
