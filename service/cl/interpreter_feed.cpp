// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "meridian/units.hpp"
#include "service/cl/interpreter.hpp"

namespace meridian::cl {
namespace {

constexpr double kFastestFeed_mm_per_s = 1e6 / 60.0;  // beyond it a feed is absurd
constexpr double kLargestCutter_mm = 120;

}  // namespace

Interpreter::Result Interpreter::take_units(const Statement& s) {
  LengthUnit unit = LengthUnit::kMillimetre;
  if (s.argument_count == 1 && (s.has_word("MM") || s.has_word("MMS"))) {
    unit = LengthUnit::kMillimetre;
  } else if (s.argument_count == 1 &&
             (s.has_word("INCHES") || s.has_word("INCH") || s.has_word("IN"))) {
    unit = LengthUnit::kInch;
  } else {
    return refuse(s.line, "unit '" + std::string(s.rest) + "' is not understood",
                  "UNITS/MM or UNITS/INCHES");
  }
  if (s.major == "UNIT") summary_.dialect = "SolidWorks CAM APT";
  if (options_.unit && *options_.unit != unit) {
    warn_once("unit told", s.line, [&] {
      return std::string(std::string("the file says ") +
                         (unit == LengthUnit::kInch ? "inch" : "millimetre") +
                         ", --units says otherwise and holds");
    });
  }
  if (unit_word_ && *unit_word_ != unit) {
    warn_once(motion_begun_ ? "unit change" : "two units", s.line, [&] {
      return std::string(motion_begun_ ? "the unit changes in mid-program"
                                       : "the file tells two units: from here on the second");
    });
  }
  unit_word_ = unit;
  unit_.reset();
  feed_dirty_ = true;
  return {};
}

Interpreter::Result Interpreter::resolve_unit(std::uint32_t line) {
  if (unit_) return {};
  if (options_.unit) {
    unit_ = options_.unit;
  } else if (unit_word_) {
    unit_ = unit_word_;
  } else if (options_.default_unit) {
    unit_ = options_.default_unit;
    warn_once("unit default", line,
              [&] { return std::string("no unit word: the machine's default unit is taken"); });
  } else {
    return refuse(line, "motion, but the file does not say its unit", "--units mm or --units inch");
  }
  to_mm_ = *unit_ == LengthUnit::kInch ? units::kInch_mm : 1.0;
  summary_.unit = *unit_;
  feed_dirty_ = true;
  if (*unit_ == LengthUnit::kInch && cutter_written_ * to_mm_ > kLargestCutter_mm) {
    metric_suspected_ = true;
    warn_once("metric", line, [&] {
      return std::string("inch, but the cutter is " + short_number(cutter_written_) +
                         " wide: plainly metric? (--units mm)");
    });
  }
  return {};
}

/// The unit that a word of FEDRAT tells; kNone: it is none.
Interpreter::FeedUnit Interpreter::feed_unit_of(std::string_view word) {
  struct Entry {
    std::string_view text;
    FeedUnit unit;
  };
  constexpr std::array kUnits = std::to_array<Entry>({{"MMPM", FeedUnit::kMillimetrePerMinute},
                                                      {"MMPMIN", FeedUnit::kMillimetrePerMinute},
                                                      {"IPM", FeedUnit::kInchPerMinute},
                                                      {"PERMIN", FeedUnit::kPerMinute},
                                                      {"UPM", FeedUnit::kPerMinute},
                                                      {"MMPR", FeedUnit::kMillimetrePerRevolution},
                                                      {"IPR", FeedUnit::kInchPerRevolution},
                                                      {"PERREV", FeedUnit::kPerRevolution},
                                                      {"UPR", FeedUnit::kPerRevolution},
                                                      {"INVERS", FeedUnit::kInverseTime},
                                                      {"INVERSE", FeedUnit::kInverseTime},
                                                      {"FRN", FeedUnit::kInverseTime}});
  const auto* const at = std::find_if(kUnits.begin(), kUnits.end(), [word](const Entry& entry) {
    return is_word(word, entry.text);
  });
  return at != kUnits.end() ? at->unit : FeedUnit::kNone;
}

Interpreter::Result Interpreter::take_feed(const Statement& s) {
  FeedUnit unit = FeedUnit::kNone;
  const Argument* number = s.only_number();
  bool automatic = false;
  for (std::size_t i = 0; i < s.argument_count; ++i) {
    const Argument& a = s.arguments[i];
    if (a.is_number) continue;
    const FeedUnit told = feed_unit_of(a.text);
    if (is_word(a.text, "AUTO")) {
      automatic = true;
    } else if (told == FeedUnit::kNone) {
      return refuse(s.line, "feed unit '" + std::string(a.text) + "' is not understood",
                    "MMPM, IPM, PERMIN, MMPR, IPR, PERREV or INVERS");
    } else if (unit != FeedUnit::kNone) {
      return refuse(s.line, "FEDRAT/" + std::string(s.rest.substr(0, 40)) + " tells two units");
    } else {
      unit = told;
    }
  }
  if (unit == FeedUnit::kNone) unit = FeedUnit::kPerMinute;
  if (unit == FeedUnit::kInverseTime && number == nullptr && s.number_count == 0) {
    warn_once("inverse", s.line, [&] {
      return std::string(
          "FEDRAT/INVERS without a number asks a post-processor for inverse time: skipped");
    });
    return {};
  }
  if (number == nullptr || automatic || s.has_empty_argument) {
    return refuse(s.line, "FEDRAT needs one number");
  }
  if (!(number->number > 0)) {
    return refuse(s.line, "feed " + short_number(number->number) + " is not above zero");
  }
  feed_unit_ = unit;
  feed_written_ = number->number;
  feed_dirty_ = true;
  if (rapid_) {
    rapid_ = false;
    warn_once("rapid feed", s.line, [&] {
      return std::string(
          "FEDRAT between RAPID and the motion: the feed holds, the motion is not rapid");
    });
  }
  return {};
}

Interpreter::Result Interpreter::resolve_feed(std::uint32_t line) {
  const bool inch = *unit_ == LengthUnit::kInch;
  double factor = to_mm_;
  bool per_revolution = false;
  feed_meaning_ = FeedMeaning::kTip;
  switch (feed_unit_) {
    case FeedUnit::kNone:
      if (!options_.default_feed_mm_per_s) {
        return refuse(line, "cutting motion, but no FEDRAT before it", "--feed MM_PER_MIN");
      }
      feed_ = *options_.default_feed_mm_per_s;
      feed_dirty_ = false;
      summary_.feed_min_mm_per_s = std::min(summary_.feed_min_mm_per_s, feed_);
      summary_.feed_max_mm_per_s = std::max(summary_.feed_max_mm_per_s, feed_);
      return {};
    case FeedUnit::kPerMinute:
      break;
    case FeedUnit::kMillimetrePerMinute:
      factor = 1;
      break;
    case FeedUnit::kInchPerMinute:
      factor = units::kInch_mm;
      break;
    case FeedUnit::kPerRevolution:
      per_revolution = true;
      break;
    case FeedUnit::kMillimetrePerRevolution:
      factor = 1;
      per_revolution = true;
      break;
    case FeedUnit::kInchPerRevolution:
      factor = units::kInch_mm;
      per_revolution = true;
      break;
    case FeedUnit::kInverseTime:
      feed_meaning_ = FeedMeaning::kInverseTime;
      feed_ = units::per_s_from_per_min(feed_written_);
      feed_dirty_ = false;
      return {};
  }
  const bool metric_feed = feed_unit_ == FeedUnit::kMillimetrePerMinute ||
                           feed_unit_ == FeedUnit::kMillimetrePerRevolution;
  const bool inch_feed =
      feed_unit_ == FeedUnit::kInchPerMinute || feed_unit_ == FeedUnit::kInchPerRevolution;
  if ((inch && metric_feed) || (!inch && inch_feed)) {
    warn_once("feed unit", line, [&] {
      return std::string(std::string("points in ") + (inch ? "inch" : "millimetre") +
                         ", but feed in " + (inch ? "millimetre" : "inch") +
                         ": both are taken as written");
    });
  }
  if (per_revolution) {
    if (!spindle_on_ || !(spindle_rpm_ > 0)) {
      return refuse(line, "feed per revolution, but no spindle speed is in force",
                    "write SPINDL/... with a speed in rev/min before it");
    }
    factor *= spindle_rpm_;
  }
  feed_ = units::per_s_from_per_min(feed_written_ * factor);
  if (!(feed_ <= kFastestFeed_mm_per_s)) {
    return refuse(line, "feed " + short_number(units::per_min_from_per_s(feed_)) +
                            " mm/min is beyond 1e6 mm/min");
  }
  feed_dirty_ = false;
  summary_.feed_min_mm_per_s = std::min(summary_.feed_min_mm_per_s, feed_);
  summary_.feed_max_mm_per_s = std::max(summary_.feed_max_mm_per_s, feed_);
  if (options_.max_feed_mm_per_s > 0 && feed_ > options_.max_feed_mm_per_s) {
    warn_once("feed beyond", line, [&] {
      return std::string("feed " + short_number(units::per_min_from_per_s(feed_)) +
                         " mm/min is beyond the machine's " +
                         short_number(units::per_min_from_per_s(options_.max_feed_mm_per_s)) +
                         " mm/min and will be limited");
    });
  }
  return {};
}

}  // namespace meridian::cl
