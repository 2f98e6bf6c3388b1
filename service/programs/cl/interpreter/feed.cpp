// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/interpreter/feed.hpp"

#include <algorithm>
#include <array>

#include "meridian/units.hpp"
#include "service/programs/cl/text/statement.hpp"
#include "service/programs/cl/text/written_text.hpp"

namespace meridian::cl {
namespace {

constexpr double kFastestFeed_mm_per_s = 1e6 / 60.0;  // beyond it a feed is absurd
constexpr double kFoot_mm = 12 * units::kInch_mm;

struct UnitWord {
  std::string_view text;
  FeedUnit unit;
};
constexpr std::array kUnitWords =
    std::to_array<UnitWord>({{"MMPM", FeedUnit::kMillimetrePerMinute},
                             {"MMPMIN", FeedUnit::kMillimetrePerMinute},
                             {"IPM", FeedUnit::kInchPerMinute},
                             {"FPM", FeedUnit::kFootPerMinute},
                             {"PERMIN", FeedUnit::kPerMinute},
                             {"UPM", FeedUnit::kPerMinute},
                             {"MMPR", FeedUnit::kMillimetrePerRevolution},
                             {"IPR", FeedUnit::kInchPerRevolution},
                             {"FPR", FeedUnit::kFootPerRevolution},
                             {"PERREV", FeedUnit::kPerRevolution},
                             {"UPR", FeedUnit::kPerRevolution},
                             {"INVERS", FeedUnit::kInverseTime},
                             {"INVERSE", FeedUnit::kInverseTime},
                             {"FRN", FeedUnit::kInverseTime},
                             {"FPT", FeedUnit::kPerTooth},
                             {"IPT", FeedUnit::kPerTooth},
                             {"MMPT", FeedUnit::kPerTooth},
                             {"MMPF", FeedUnit::kPerTooth}});

/// What a unit of feed is: its length, and whether it is per revolution.
struct UnitMeaning {
  double length_mm = 0;  ///< 0: the unit of the file
  bool is_per_revolution = false;
};

UnitMeaning meaning_of(FeedUnit unit) {
  switch (unit) {
    case FeedUnit::kMillimetrePerMinute:
      return {1, false};
    case FeedUnit::kInchPerMinute:
      return {units::kInch_mm, false};
    case FeedUnit::kFootPerMinute:
      return {kFoot_mm, false};
    case FeedUnit::kPerRevolution:
      return {0, true};
    case FeedUnit::kMillimetrePerRevolution:
      return {1, true};
    case FeedUnit::kInchPerRevolution:
      return {units::kInch_mm, true};
    case FeedUnit::kFootPerRevolution:
      return {kFoot_mm, true};
    default:
      return {};
  }
}

}  // namespace

FeedUnit feed_unit_of(std::string_view word) {
  const auto at = std::find_if(kUnitWords.begin(), kUnitWords.end(),
                               [word](const UnitWord& row) { return is_word(word, row.text); });
  return at != kUnitWords.end() ? at->unit : FeedUnit::kNone;
}

Expected<MotionFeed, Refusal> feed_of(const WrittenFeed& written, const FeedContext& context) {
  if (written.unit == FeedUnit::kInverseTime) {
    return MotionFeed{BlockKind::kCut, FeedMeaning::kInverseTime,
                      units::per_s_from_per_min(written.value)};
  }
  if (written.unit == FeedUnit::kPerTooth) {
    return refuse("a feed per tooth needs the number of teeth", "output the feed per minute");
  }
  const UnitMeaning meaning = meaning_of(written.unit);
  double factor = meaning.length_mm;
  if (factor == 0) factor = context.unit == LengthUnit::kInch ? units::kInch_mm : 1;
  if (meaning.is_per_revolution) {
    if (!context.spindle.turns()) {
      return refuse("feed per revolution, but no spindle speed is in force",
                    "write SPINDL/... with a speed in rev/min before it");
    }
    factor *= context.spindle.speed_rpm;
  }
  const double feed = units::per_s_from_per_min(written.value * factor);
  if (!(feed <= kFastestFeed_mm_per_s)) {
    return refuse("feed " + short_number(units::per_min_from_per_s(feed)) +
                  " mm/min is beyond 1e6 mm/min");
  }
  return MotionFeed{BlockKind::kCut, FeedMeaning::kTip, feed};
}

std::optional<LengthUnit> length_unit_of(FeedUnit feed) {
  const double length_mm = meaning_of(feed).length_mm;
  if (length_mm == 0) return std::nullopt;
  return length_mm == 1 ? LengthUnit::kMillimetre : LengthUnit::kInch;
}

bool is_of_other_unit(FeedUnit feed, LengthUnit unit) {
  return length_unit_of(feed).value_or(unit) != unit;
}

void remark_on_feed(const WrittenFeed& written, const MotionFeed& feed, LengthUnit unit,
                    double max_feed_mm_per_s, std::uint32_t line, Remarks& remarks) {
  const bool is_inch = unit == LengthUnit::kInch;
  if (is_of_other_unit(written.unit, unit)) {
    remarks.warn("feed unit", line, [is_inch] {
      return std::string("points in ") + (is_inch ? "inch" : "millimetre") + ", but feed in " +
             (is_inch ? "millimetre" : "inch") + ": both are taken as written";
    });
  }
  if (feed.meaning == FeedMeaning::kTip && max_feed_mm_per_s > 0 && feed.feed > max_feed_mm_per_s) {
    remarks.warn("feed beyond", line, [&] {
      return "feed " + short_number(units::per_min_from_per_s(feed.feed)) +
             " mm/min is beyond the machine's " +
             short_number(units::per_min_from_per_s(max_feed_mm_per_s)) +
             " mm/min and will be limited";
    });
  }
}

}  // namespace meridian::cl
