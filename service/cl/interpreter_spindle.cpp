// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "service/cl/interpreter.hpp"

namespace meridian::cl {
namespace {

constexpr double kMostGears = 99;

/// What may stand behind RANGE: the number of a gear or its name.
bool is_gear(const Argument& a) {
  if (a.is_number)
    return a.number >= 0 && a.number <= kMostGears && a.number == std::floor(a.number);
  return is_word(a.text, "LOW") || is_word(a.text, "MEDIUM") || is_word(a.text, "MED") ||
         is_word(a.text, "HIGH");
}

}  // namespace

/// The words of a SPINDL statement, each alone; what they mean together is take_spindle's.
Expected<Interpreter::SpindleWords, ClError> Interpreter::spindle_words(const Statement& s) {
  SpindleWords words;
  for (std::size_t i = 0; i < s.argument_count; ++i) {
    const Argument& a = s.arguments[i];
    const Argument* const next = i + 1 < s.argument_count ? &s.arguments[i + 1] : nullptr;
    if (a.is_number) {
      if (words.speed != nullptr) return refuse(s.line, "SPINDL has several numbers");
      words.speed = &a;
    } else if (is_word(a.text, "RPM") || is_word(a.text, "ON")) {
      words.turns = true;
    } else if (is_word(a.text, "CLW") || is_word(a.text, "FWD")) {
      words.turns = true;
      words.sense = ActionKind::kSpindleClockwise;
    } else if (is_word(a.text, "CCLW") || is_word(a.text, "REV")) {
      words.turns = true;
      words.sense = ActionKind::kSpindleCounterClockwise;
    } else if (is_word(a.text, "SFM") || is_word(a.text, "SMM") || is_word(a.text, "SURF")) {
      return refuse(s.line, "spindle by surface speed needs the radius being cut",
                    "output the speed in rev/min");
    } else if (is_word(a.text, "RANGE")) {
      words.left = "RANGE";
      i += next != nullptr && is_gear(*next) ? 1 : 0;
    } else if (is_word(a.text, "MAXRPM") && next != nullptr && next->is_number) {
      words.left = "MAXRPM";
      ++i;
    } else if (words.other.empty()) {
      words.other = a.text;
    }
  }
  return words;
}

Interpreter::Result Interpreter::take_spindle(const Statement& s, Blocks& out) {
  if (s.has_word("OFF")) {
    spindle_on_ = false;
    feed_dirty_ = true;
    action(BlockKind::kAuxiliary, ActionKind::kSpindleOff, 0, s.line, out);
    return {};
  }
  const auto words = spindle_words(s);
  if (!words) return tl::make_unexpected(words.error());
  const bool takes_angle = is_word(words->other, "ORIENT") || is_word(words->other, "LOCK");
  const bool tells_speed = words->turns || (words->speed != nullptr && !takes_angle);
  if (!words->other.empty() && tells_speed) {
    return refuse(s.line, "SPINDL word '" + std::string(words->other) +
                              "' beside a speed or a sense is not understood");
  }
  if (!tells_speed && s.argument_count > 0) {
    vendor_word(s, out);  // ORIENT, LOCK, a gear alone: the machine's own business
    return {};
  }
  if (words->speed != nullptr) {
    const double speed = words->speed->number;
    if (!(speed >= 0 && speed <= 1e6)) {
      return refuse(s.line, "spindle speed " + short_number(speed) + " makes no sense");
    }
    spindle_rpm_ = speed;
  } else if (!(spindle_rpm_ > 0)) {
    return refuse(s.line, "SPINDL/" + std::string(s.rest) + " before any speed was told");
  }
  if (!words->left.empty()) {
    warn_once(words->left, s.line, [&] {
      return std::string("SPINDL: " + std::string(words->left) + " is left to the machine");
    });
  }
  spindle_sense_ = words->sense.value_or(spindle_sense_);
  spindle_on_ = true;
  feed_dirty_ = true;
  action(BlockKind::kAuxiliary, spindle_sense_, spindle_rpm_, s.line, out);
  return {};
}

/// ON says nothing beside another word.
Interpreter::Result Interpreter::take_coolant(const Statement& s, Blocks& out) {
  const bool is_on = s.has_word("ON");
  const bool is_on_alone = is_on && s.argument_count == 1;
  const bool has_one_word = s.argument_count == (is_on ? 2U : 1U);
  ActionKind what = ActionKind::kVendorWord;
  if (s.has_word("OFF")) {
    what = ActionKind::kCoolantOff;
  } else if (is_on_alone || (has_one_word && s.has_word("FLOOD"))) {
    what = ActionKind::kCoolantFlood;
  } else if (has_one_word && s.has_word("MIST")) {
    what = ActionKind::kCoolantMist;
  } else if (has_one_word && (s.has_word("THRU") || s.has_word("THROUGH"))) {
    what = ActionKind::kCoolantThrough;
  }
  if (what == ActionKind::kVendorWord) {
    vendor_word(s, out);
  } else {
    action(BlockKind::kAuxiliary, what, 0, s.line, out);
  }
  return {};
}

}  // namespace meridian::cl
