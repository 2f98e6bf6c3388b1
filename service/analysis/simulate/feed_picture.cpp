// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/feed_picture.hpp"

#include <algorithm>
#include <cstdio>

#include "meridian/units.hpp"

namespace meridian::simulate {
namespace {

using plot::quoted;

/// Limits that are distinguished by colour; what is rarer is grey.
constexpr std::size_t kColours = 9;
constexpr const char* kColour[kColours] = {"#1f5fa8", "#e08214", "#c22f4f", "#7b4fa3", "#17a2a2",
                                           "#d4b106", "#e377c2", "#8c564b", "#444444"};
constexpr const char* kAtFeed = "#a8d5a2";
constexpr const char* kOther = "#bbbbbb";

[[nodiscard]] LimitId find_main(const std::array<float, kLimitIds>& by_limit) {
  return static_cast<LimitId>(std::max_element(by_limit.begin(), by_limit.end()) -
                              by_limit.begin());
}

}  // namespace

void FeedPicture::add_to(Column& to, const Column& from) {
  to.time_s += from.time_s;
  to.distance_mm += from.distance_mm;
  to.programmed_mm_per_s = std::max(to.programmed_mm_per_s, from.programmed_mm_per_s);
  for (std::size_t n = 0; n < kLimitIds; ++n) to.by_limit[n] += from.by_limit[n];
}

void FeedPicture::merge_pairs() {
  for (std::size_t n = 0; n < columns_.size() / 2; ++n) {
    Column both = columns_[2 * n];
    add_to(both, columns_[2 * n + 1]);
    columns_[n] = both;
  }
  columns_.resize(columns_.size() / 2);
  cycles_per_column_ *= 2;
  cycles_in_last_ = cycles_per_column_;
}

void FeedPicture::add(const ExplainedCycle& cycle) {
  if (columns_.empty() || cycles_in_last_ == cycles_per_column_) {
    if (columns_.size() == kMaxColumns) merge_pairs();
    columns_.emplace_back();
    cycles_in_last_ = 0;
  }
  Column one{cycle.time_s, cycle.distance_mm, cycle.programmed_mm_per_s, {}};
  one.by_limit[cycle.limit] = static_cast<float>(cycle.time_s);
  add_to(columns_.back(), one);
  ++cycles_in_last_;
}

std::optional<plot::PlotError> FeedPicture::draw(const std::string& file,
                                                 const std::string& title) const {
  if (columns_.empty()) {
    return plot::PlotError{file, "nothing was cut", "there is nothing to draw"};
  }
  return plot::draw(file, {1500, 1000, 16, 12}, [&](std::FILE* out) { print(out, title); });
}

/// Data block $feed: begin and end of each column in s and in mm, feed achieved and programmed in
/// mm/min, place of its limit in `shown`.
void FeedPicture::print_columns(std::FILE* out, const std::vector<LimitId>& shown) const {
  std::fputs("$feed << EOD\n", out);
  double time = 0, distance = 0;
  for (const Column& column : columns_) {
    const LimitId main = find_main(column.by_limit);
    const auto index = std::find(shown.begin(), shown.end(), main) - shown.begin();
    std::fprintf(out, "%.7g %.7g %.7g %.7g %.5g %.5g %d\n", time, time + column.time_s, distance,
                 distance + column.distance_mm,
                 units::per_min_from_per_s(column.distance_mm / column.time_s),
                 units::per_min_from_per_s(column.programmed_mm_per_s), static_cast<int>(index));
    time += column.time_s;
    distance += column.distance_mm;
  }
  std::fputs("EOD\n", out);
}

void FeedPicture::print(std::FILE* out, const std::string& title) const {
  std::array<double, kLimitIds> time{};
  double whole = 0, max = 0;
  for (const Column& column : columns_) {
    whole += column.time_s;
    max = std::max({max, column.distance_mm / column.time_s, column.programmed_mm_per_s});
    for (std::size_t n = 0; n < kLimitIds; ++n) time[n] += static_cast<double>(column.by_limit[n]);
  }
  std::vector<LimitId> shown;
  for (std::size_t n = 0; n < kLimitIds; ++n) {
    if (time[n] > 0) shown.push_back(static_cast<LimitId>(n));
  }
  std::stable_sort(shown.begin(), shown.end(),
                   [&time](LimitId a, LimitId b) { return time[a] > time[b]; });
  if (shown.size() > kColours) shown.resize(kColours);

  print_columns(out, shown);
  std::fprintf(out, "set multiplot title %s font ',20'\n", quoted(title).c_str());
  std::fprintf(
      out,
      "set grid lc '#dddddd'\nset border lc '#555555'\nset style fill solid 0.75 noborder\n"
      "set key outside right top noreverse Left samplen 1.2\nset rmargin 34\nset xtics out "
      "nomirror\nset autoscale xfix\n"
      "set lmargin 12\nset yrange [0:%.6g]\nset ylabel 'tip, mm/min'\n",
      units::per_min_from_per_s(1.15 * max));
  double others = whole;
  for (const LimitId id : shown) others -= time[id];
  const auto panel = [&](int from, const char* label, double bottom) {
    std::fprintf(out, "set origin 0,%.3f\nset size 1,0.47\nset xlabel '%s'\nplot", bottom, label);
    for (std::size_t n = 0; n <= shown.size(); ++n) {
      const bool is_other = n == shown.size();
      if (is_other && !(others > 0.0005 * whole)) continue;
      const double share = 100 * (is_other ? others : time[shown[n]]) / whole;
      char name[80];
      std::snprintf(name, sizeof name, "%s %.1f %%",
                    is_other ? "others" : name_of(shown[n], model_).c_str(), share);
      // A box from the column's begin to its end, from zero to the feed achieved.
      std::fprintf(out,
                   " $feed using ($7==%d?0.5*($%d+$%d):NaN):(0.5*$5):%d:%d:(0):5 with "
                   "boxxyerrorbars lc '%s' title %s,",
                   static_cast<int>(n), from, from + 1, from, from + 1,
                   is_other                 ? kOther
                   : shown[n] == kFeedLimit ? kAtFeed
                                            : kColour[n],
                   quoted(name).c_str());
    }
    std::fprintf(out,
                 " $feed using %d:5 with steps lw 1.5 lc '#333333' title 'achieved', $feed using "
                 "%d:($6>0?$6:NaN) with steps lw 2 dt 2 lc '#111111' title 'programmed'\n",
                 from, from);
  };
  panel(1, "time, s", 0.48);
  std::fputs("unset key\n", out);
  panel(3, "path of the tip, mm", 0.0);
}

}  // namespace meridian::simulate
