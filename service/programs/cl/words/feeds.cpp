// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/cl/words/handlers.hpp"
#include "service/programs/cl/words/unit_by_feed.hpp"

namespace meridian::cl {
namespace {

std::optional<LengthUnit> unit_of(const Statement& s) {
  if (s.argument_count != 1) return std::nullopt;
  for (const char* const word : {"MM", "MMS", "METRIC"}) {
    if (s.has_word(word)) return LengthUnit::kMillimetre;
  }
  for (const char* const word : {"INCHES", "INCH", "IN"}) {
    if (s.has_word(word)) return LengthUnit::kInch;
  }
  return std::nullopt;
}

/// Words of FEDRAT that are asked of a post-processor and change no feed.
bool is_for_post(std::string_view word) {
  return is_word(word, "LOCK") || is_word(word, "MAXIPM") || is_word(word, "MAXDPM") ||
         is_word(word, "LENGTH");
}

}  // namespace

Outcome read_units(Modal& m, const Statement& s) {
  const auto unit = unit_of(s);
  if (!unit) {
    return refuse("unit " + quoted(s.rest) + " is not understood", "UNITS/MM or UNITS/INCHES");
  }
  if (m.options.unit && *m.options.unit != *unit) {
    m.remarks.warn("unit stated", s.line, [&unit] {
      return std::string("the file says ") + name_of(*unit) + ", --units says otherwise and holds";
    });
  }
  if (m.units.stated && *m.units.stated != *unit) {
    const bool has_begun = m.path.position() != BlockPath::Position::kUnknown;
    m.remarks.warn(has_begun ? "unit change" : "two units", s.line, [has_begun] {
      return has_begun ? "the unit changes in mid-program"
                       : "the file states two units: from here on the second";
    });
  }
  m.units.stated = *unit;
  m.units.in_force.reset();
  m.feed.reset();
  return {};
}

Outcome read_feed(Modal& m, const Statement& s) {
  see_unit_by_feed(m, s);
  WrittenFeed feed;
  bool is_automatic = false, asks_post = false;
  for (std::size_t i = 0; i < s.argument_count; ++i) {
    const Argument& a = s.arguments[i];
    if (a.is_number) continue;
    const FeedUnit unit = feed_unit_of(a.text);
    if (is_word(a.text, "AUTO") || is_word(a.text, "OFF")) {
      is_automatic = true;
    } else if (is_for_post(a.text)) {
      asks_post = true;
    } else if (unit == FeedUnit::kNone) {
      return refuse("feed unit " + quoted(a.text) + " is not understood",
                    "MMPM, IPM, PERMIN, MMPR, IPR, PERREV or INVERS");
    } else if (feed.unit != FeedUnit::kNone) {
      return refuse("FEDRAT/" + std::string(s.rest.substr(0, 40)) + " has two units");
    } else {
      feed.unit = unit;
    }
  }
  if (feed.unit == FeedUnit::kInverseTime && s.number_count == 0) {
    m.remarks.warn("inverse", s.line, [] {
      return "FEDRAT/INVERS without a number asks a post-processor for inverse time: skipped";
    });
    return {};
  }
  if (asks_post && feed.unit == FeedUnit::kNone) return skip(m, s);
  const Argument* const number = s.only_number();
  if (number == nullptr || is_automatic || asks_post || s.has_empty_argument()) {
    return refuse("FEDRAT needs one number");
  }
  feed.value = number->number;
  if (!(feed.value > 0)) {
    return refuse("feed " + short_number(feed.value) + " is not above zero");
  }
  if (feed.unit == FeedUnit::kNone) feed.unit = FeedUnit::kPerMinute;
  m.written_feed = feed;
  m.feed.reset();
  if (m.next == NextMotion::kRapid) {
    m.next = NextMotion::kFeed;
    m.remarks.warn("rapid feed", s.line, [] {
      return "FEDRAT between RAPID and the motion: the feed holds, the motion is not rapid";
    });
  }
  return {};
}

Outcome read_transition(Modal& m, const Statement& s) {
  const bool is_one_word = s.argument_count == 1 && !s.arguments[0].is_number;
  if (is_one_word && is_word(s.arguments[0].text, "EXACT_STOP")) {
    m.join = BlockJoin::kExactStop;
  } else if (is_one_word && is_word(s.arguments[0].text, "SMOOTH")) {
    m.join = BlockJoin::kByMachine;
  } else {
    return refuse("TRANSITION/" + std::string(s.rest.substr(0, 40)) + " is not understood",
                  "TRANSITION/EXACT_STOP from there on, TRANSITION/SMOOTH to end it");
  }
  return {};
}

}  // namespace meridian::cl
