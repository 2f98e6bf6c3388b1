// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/compare.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <utility>

#include "service/recording/record/words.hpp"
#include "service/text/printed.hpp"

namespace meridian::record {
namespace {

using text::Count;

/// Plan times this close are one, s: far below any cycle time.
constexpr double kSamePlanTime_s = 1e-9;

[[nodiscard]] bool is_same_bits(double a, double b) noexcept {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// One recording's motion: rows from the first in which the joints move to the last of the program.
class Motion {
 public:
  explicit Motion(RecordingReader& reader) : reader_(reader) { reader_.rewind(); }

  RecordingRow row, before;
  bool is_there = false;
  std::uint64_t rows = 0, missing = 0;

  [[nodiscard]] std::optional<RecordError> find_first() {
    bool has_before = false;
    for (;;) {
      auto read = reader_.next(row);
      if (!read) return std::move(read.error());
      if (!*read) return std::nullopt;
      const bool is_enabled = is_leading(row.flags);
      if (has_before && is_enabled && row.joints != before.joints) break;
      has_before = is_enabled;
      before = row;
    }
    is_there = true;
    rows = 1;
    return std::nullopt;
  }

  [[nodiscard]] std::optional<RecordError> next() {
    before = row;
    auto read = reader_.next(row);
    if (!read) return std::move(read.error());
    is_there = *read && is_leading(row.flags) && row.plan_time_s >= before.plan_time_s;
    if (!is_there) return std::nullopt;
    ++rows;
    missing += row.cycle - before.cycle - 1;
    return std::nullopt;
  }

  [[nodiscard]] bool is_after_gap() const noexcept { return row.cycle > before.cycle + 1; }

 private:
  RecordingReader& reader_;
};

class Comparison {
 public:
  Comparison(const MachineModel& model, ComparisonReport& report)
      : model_(model), report_(report) {}

  void match(const RecordingRow& a, const RecordingRow& b) {
    ++report_.compared;
    last_a_ = a;
    last_b_ = b;
    check(a, b);
  }

  /// A row that repeats the plan time matched last: at rest, one waited longer than the other.
  [[nodiscard]] bool is_rest(const RecordingRow& row) const noexcept {
    return report_.compared > 0 &&
           std::abs(row.plan_time_s - last_a_.plan_time_s) <= kSamePlanTime_s;
  }
  void rest_of_a(const RecordingRow& row) { check(row, last_b_); }
  void rest_of_b(const RecordingRow& row) { check(last_a_, row); }

 private:
  void check(const RecordingRow& a, const RecordingRow& b) {
    bool is_different = false;
    for (int i = 0; i < limited_count(model_); ++i) {
      if (is_same_bits(a.positions[i], b.positions[i])) continue;
      report_.largest_difference =
          std::max(report_.largest_difference, std::abs(a.positions[i] - b.positions[i]));
      if (!is_different && report_.different == 0) {
        report_.first_difference_a = a.cycle;
        report_.first_difference_b = b.cycle;
        report_.first_line = a.line;
        report_.first_joint = i;
        report_.first_a = a.positions[i];
        report_.first_b = b.positions[i];
        report_.first_plan_time_s = a.plan_time_s;
      }
      is_different = true;
    }
    if (is_different) ++report_.different;
  }

  const MachineModel& model_;
  ComparisonReport& report_;
  RecordingRow last_a_, last_b_;
};

/// How far `a` is ahead of `b` in the program: by plan time, and at one plan time, which is a rest,
/// by block. Only the sign counts; 0: the same position.
[[nodiscard]] double lead(const RecordingRow& a, const RecordingRow& b) noexcept {
  const double earlier_by = a.plan_time_s - b.plan_time_s;
  if (std::abs(earlier_by) > kSamePlanTime_s) return earlier_by;
  return a.sequence == b.sequence ? 0 : (a.sequence < b.sequence ? -1 : 1);
}

[[nodiscard]] std::optional<RecordError> merge(Motion& a, Motion& b, Comparison& comparison,
                                               ComparisonReport& report) {
  const auto only = [&report](std::uint64_t& count, bool is_explained) {
    ++count;
    if (!is_explained) ++report.unexplained;
  };
  while (a.is_there && b.is_there) {
    const double earlier_by = lead(a.row, b.row);
    std::optional<RecordError> error;
    if (earlier_by == 0) {
      comparison.match(a.row, b.row);
      error = a.next();
      if (!error) error = b.next();
    } else if (earlier_by < 0) {
      if (comparison.is_rest(a.row)) {
        comparison.rest_of_a(a.row);
      } else {
        only(report.only_a, b.is_after_gap());
      }
      error = a.next();
    } else {
      if (comparison.is_rest(b.row)) {
        comparison.rest_of_b(b.row);
      } else {
        only(report.only_b, a.is_after_gap());
      }
      error = b.next();
    }
    if (error) return error;
  }
  // One has ended: what the other still has is rest, or motion that the first never made.
  while (a.is_there || b.is_there) {
    Motion& left = a.is_there ? a : b;
    if (!comparison.is_rest(left.row)) only(a.is_there ? report.only_a : report.only_b, false);
    if (auto error = left.next()) return error;
  }
  return std::nullopt;
}

}  // namespace

Expected<ComparisonReport, RecordError> compare(RecordingReader& a, RecordingReader& b,
                                                const MachineModel& model) {
  for (const RecordingReader* reader : {&a, &b}) {
    if (reader->has_plan_time()) continue;
    return tl::make_unexpected(
        RecordError{reader->path(), 1, "the header has no column 'plan_time_s'",
                    "compare recordings of the service or of meridian simulate"});
  }
  ComparisonReport report;
  Motion of_a(a), of_b(b);
  auto error = of_a.find_first();
  if (!error) error = of_b.find_first();
  Comparison comparison(model, report);
  if (!error) error = merge(of_a, of_b, comparison, report);
  if (error) return tl::make_unexpected(std::move(*error));
  report.rows_a = of_a.rows;
  report.rows_b = of_b.rows;
  report.gaps_a = of_a.missing;
  report.gaps_b = of_b.missing;
  return report;
}

std::string to_text(const ComparisonReport& report, const std::string& name_a,
                    const std::string& name_b, const MachineModel& model) {
  char line[512];
  std::string text;
  const auto side = [&](const char* label, const std::string& name, std::uint64_t rows,
                        std::uint64_t gaps, std::uint64_t only) {
    std::snprintf(line, sizeof line,
                  "%s          %s: %llu cycles from the first motion on, %llu missing, %llu plan "
                  "times of its own\n",
                  label, name.c_str(), static_cast<Count>(rows), static_cast<Count>(gaps),
                  static_cast<Count>(only));
    text += line;
  };
  side("A", name_a, report.rows_a, report.gaps_a, report.only_a);
  side("B", name_b, report.rows_b, report.gaps_b, report.only_b);
  std::snprintf(line, sizeof line, "compared   %llu cycles, %llu differ\n",
                static_cast<Count>(report.compared), static_cast<Count>(report.different));
  text += line;
  if (report.is_same()) return text + "SAME\n";
  if (report.compared == 0) return text + "DIFFERENT: no cycle in common\n";
  if (report.different > 0) {
    std::snprintf(
        line, sizeof line,
        "first      cycle %llu of A, %llu of B, plan time %.6f s, line %u: %s is %.17g in "
        "A, %.17g in B; largest difference %.3g\n",
        static_cast<Count>(report.first_difference_a),
        static_cast<Count>(report.first_difference_b), report.first_plan_time_s, report.first_line,
        position_column(limited_spec(model, report.first_joint)).c_str(), report.first_a,
        report.first_b, report.largest_difference);
    text += line;
  }
  if (report.unexplained > 0) {
    std::snprintf(line, sizeof line,
                  "           %llu plan times stand in one alone and are no missing cycles of the "
                  "other: a hold, an override or another program\n",
                  static_cast<Count>(report.unexplained));
    text += line;
  }
  return text + "DIFFERENT\n";
}

}  // namespace meridian::record
