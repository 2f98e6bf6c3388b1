// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "service/analysis/plot/gnuplot.hpp"
#include "service/analysis/simulate/explainer.hpp"

namespace meridian::simulate {

/// The picture of a run's feed: programmed and achieved over time and over the tip's way, every
/// column in the colour of the limit that held most of it, and the time that each limit took.
///
/// Cycles are gathered in columns that double their width where they become too many: memory does
/// not grow with the program.
class FeedPicture {
 public:
  static constexpr std::size_t kMaxColumns = 1600;

  explicit FeedPicture(const MachineModel& model) : model_(model) { columns_.reserve(kMaxColumns); }

  void add(const ExplainedCycle& cycle);

  /// Draws `file` (.png or .svg) by gnuplot. Blocks. Proof: tests/unit/simulate/explain_test.cpp.
  [[nodiscard]] std::optional<plot::PlotError> draw(const std::string& file,
                                                    const std::string& title) const;

 private:
  struct Column {
    double time_s = 0, distance_mm = 0;
    double programmed_mm_per_s = 0;  ///< largest
    std::array<float, kLimitIds> by_limit{};
  };
  void merge_pairs();
  static void add_to(Column& to, const Column& from);
  void print(std::FILE* out, const std::string& title) const;
  void print_columns(std::FILE* out, const std::vector<LimitId>& shown) const;

  const MachineModel& model_;
  std::vector<Column> columns_;
  std::size_t cycles_per_column_ = 1, cycles_in_last_ = 0;
};

}  // namespace meridian::simulate
