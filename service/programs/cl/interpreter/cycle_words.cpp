// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/interpreter/cycle_words.hpp"

#include <array>

#include "service/programs/cl/text/written_text.hpp"

namespace meridian::cl {
namespace {

/// What stands behind a keyword of a cycle.
enum class Key : std::uint8_t {
  kNone,
  kFeedTo,     ///< FEDTO: depth
  kDepth,      ///< DEPTH: depth, in pairs as ISO 4343 has them
  kRapidTo,    ///< RAPTO
  kRetractTo,  ///< RTRCTO
  kReturn,     ///< RETURN
  kClear,      ///< CLEAR
  kStep,       ///< STEP, INCR
  kFirstPeck,  ///< 1STPECK
  kNextPeck,   ///< SUBPECK
  kDwell,      ///< DWELL, s or REV,n
  kTimes,      ///< TIMES
  kBack,       ///< BACK
  kSink,       ///< CSINK: diameter and angle of a countersink
  kFeed,       ///< a unit of feed
  kNumber,     ///< a number that shapes nothing: CAM
  kModifier    ///< one of the words below
};

struct KeyRow {
  std::string_view word;
  Key key;
};
constexpr std::array kKeys = std::to_array<KeyRow>({
    {"FEDTO", Key::kFeedTo},     {"DEPTH", Key::kDepth},     {"RAPTO", Key::kRapidTo},
    {"RTRCTO", Key::kRetractTo}, {"RETURN", Key::kReturn},   {"CLEAR", Key::kClear},
    {"STEP", Key::kStep},        {"INCR", Key::kStep},       {"1STPECK", Key::kFirstPeck},
    {"SUBPECK", Key::kNextPeck}, {"DWELL", Key::kDwell},     {"TIMES", Key::kTimes},
    {"BACK", Key::kBack},        {"CSINK", Key::kSink},      {"CAM", Key::kNumber},
    {"DEEP", Key::kModifier},    {"BRKCHP", Key::kModifier}, {"DRAG", Key::kModifier},
    {"NODRAG", Key::kModifier},  {"ORIENT", Key::kModifier}, {"MANUAL", Key::kModifier},
    {"ON", Key::kModifier},
});

constexpr std::size_t kMaxPecks = 64;

/// Takes the arguments of a CYCLE statement one after the other.
class CycleArguments {
 public:
  explicit CycleArguments(const Statement& s) : s_(s), at_(1) {}

  Expected<CycleWords, Refusal> read() {
    CycleWords words;
    words.positions = numbers();
    while (at_ < s_.argument_count) {
      const std::string_view word = s_.arguments[at_++].text;
      if (auto done = take(word, words); !done) return tl::make_unexpected(done.error());
    }
    return words;
  }

 private:
  std::vector<double> numbers() {
    std::vector<double> out;
    while (at_ < s_.argument_count && s_.arguments[at_].is_number) {
      out.push_back(s_.arguments[at_++].number);
    }
    return out;
  }
  bool take_word(std::string_view word) {
    if (at_ == s_.argument_count || !is_word(s_.arguments[at_].text, word)) return false;
    ++at_;
    return true;
  }

  Outcome take(std::string_view word, CycleWords& words) {
    const FeedUnit unit = feed_unit_of(word);
    if (unit != FeedUnit::kNone) return take_feed(unit, words);
    const auto row = std::find_if(kKeys.begin(), kKeys.end(),
                                  [word](const KeyRow& r) { return is_word(word, r.word); });
    const Key key = row == kKeys.end() ? Key::kNone : row->key;
    if (key == Key::kNone) {
      return refuse("CYCLE word " + quoted(word) + " is not understood",
                    "let the CAM system write the cycle out as motion");
    }
    if (key == Key::kModifier) {
      words.modifiers.push_back(row->word);
      if (row->word == "ORIENT") (void)numbers();
      return {};
    }
    if (key == Key::kDwell) return take_dwell(words);
    if (key == Key::kRetractTo && take_word("AUTO")) {
      words.returns_to_before = true;
      return {};
    }
    return take_numbers(row->word, key, words);
  }

  Outcome take_feed(FeedUnit unit, CycleWords& words) {
    if (unit == FeedUnit::kPerTooth) {
      return refuse("a feed per tooth needs the number of teeth", "output the feed per minute");
    }
    const std::vector<double> n = numbers();
    if (n.empty() && !words.positions.empty()) return {};  // numbers by their place
    // Behind the unit its feed; of positions another number: the clearance.
    if (n.empty() || !(n[0] > 0)) return refuse("CYCLE gives a unit of feed without a feed");
    words.feeds.push_back({n[0], unit});
    words.positions.insert(words.positions.end(), n.begin() + 1, n.end());
    return {};
  }

  Outcome take_dwell(CycleWords& words) {
    const bool revolutions = take_word("REV");
    const std::vector<double> n = numbers();
    if (n.size() != 1 || !(n[0] >= 0)) return refuse("CYCLE/...,DWELL needs one number");
    (revolutions ? words.dwell_revolutions : words.dwell_s) = n[0];
    return {};
  }

  Outcome take_numbers(std::string_view word, Key key, CycleWords& words) {
    std::vector<double> n = numbers();
    const bool may_lack = key == Key::kBack || key == Key::kSink;
    if (n.empty() && may_lack) {
      words.modifiers.push_back(word);
      return {};
    }
    const std::size_t max = key == Key::kStep ? kMaxPecks : (key == Key::kSink ? 3 : 2);
    const bool one_alone =
        key != Key::kStep && key != Key::kSink && key != Key::kFeedTo && key != Key::kRetractTo;
    if (n.empty() || n.size() > (one_alone ? 1 : max)) {
      return refuse("CYCLE/...," + std::string(word) + " has " + std::to_string(n.size()) +
                    " numbers");
    }
    std::vector<double>* const list = list_of(key, words);
    if (list == nullptr) return {};
    if (!list->empty() && key != Key::kStep) {
      return refuse("CYCLE gives " + std::string(word) + " twice");
    }
    list->insert(list->end(), n.begin(), n.end());
    return {};
  }

  static std::vector<double>* list_of(Key key, CycleWords& words) {
    switch (key) {
      case Key::kFeedTo:
        return &words.feed_to;
      case Key::kDepth:
        return &words.depth;
      case Key::kRapidTo:
        return &words.rapid_to;
      case Key::kRetractTo:
        return &words.retract_to;
      case Key::kReturn:
        return &words.return_to;
      case Key::kClear:
        return &words.clear;
      case Key::kStep:
        return &words.steps;
      case Key::kFirstPeck:
        return &words.first_peck;
      case Key::kNextPeck:
        return &words.next_peck;
      case Key::kTimes:
        return &words.times;
      case Key::kBack:
        return &words.back;
      case Key::kSink:
        return &words.sink;
      default:
        return nullptr;
    }
  }

  const Statement& s_;
  std::size_t at_;
};

}  // namespace

Expected<CycleWords, Refusal> read_cycle_words(const Statement& s) {
  return CycleArguments(s).read();
}

}  // namespace meridian::cl
