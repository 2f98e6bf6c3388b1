// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/shapes/hole_cycle.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "meridian/units.hpp"
#include "service/programs/cl/interpreter/cycle_words.hpp"
#include "service/programs/cl/text/written_text.hpp"

namespace meridian::cl {
namespace {

constexpr auto kRefused = HoleKind::kDrill;
constexpr std::string_view kTapping = "is tapping, which needs a spindle that turns with the feed";
constexpr std::string_view kOrient = "stops the spindle in a certain angle before it moves out";
constexpr std::string_view kByHand = "waits for an operator who moves the spindle by hand";
constexpr std::string_view kControl = "is known to the control alone";
constexpr std::string_view kLathe = "is a cycle of a lathe";

constexpr std::array kTypes = std::to_array<HoleType>({
    {"DRILL", HoleKind::kDrill, {}},
    {"FACE", HoleKind::kDrill, {}},
    {"SPOT", HoleKind::kDrill, {}},
    {"SPDRL", HoleKind::kDrill, {}},
    {"CENTER", HoleKind::kDrill, {}},
    {"CDRILL", HoleKind::kDrill, {}},
    {"CSINK", HoleKind::kDrill, {}},
    {"CBORE", HoleKind::kDrill, {}},
    {"MILL", HoleKind::kDrill, {}},
    {"DEEP", HoleKind::kDeep, {}},
    {"DEEP2", HoleKind::kDeep, {}},
    {"PECK", HoleKind::kDeep, {}},
    {"BRKCHP", HoleKind::kChipBreak, {}},
    {"CHIPBR", HoleKind::kChipBreak, {}},
    {"REAM", HoleKind::kFeedOut, {}},
    {"BORE", HoleKind::kFeedOut, {}},
    {"TAP", kRefused, kTapping},
    {"TAP2", kRefused, kTapping},
    {"RIGID", kRefused, kTapping},
    {"REVERS", kRefused, kTapping},
    {"SHIFT", kRefused, kOrient},
    {"BORE9", kRefused, kOrient},
    {"BORE7", kRefused, kByHand},
    {"MANUAL", kRefused, kByHand},
    {"THREAD", kRefused, kLathe},
    {"TURN", kRefused, kLathe},
    {"THRU", kRefused, "feeds through several plates that the file does not give"},
    {"PROBE", kRefused, "is probing"},
    {"CIRCUL", kRefused, kControl},
    {"AVOID", kRefused, kControl},
    {"AUTO", kRefused, kControl},
    {"RETURN", kRefused, kControl},
});

constexpr double kLargest = 1e4;  // no hole is deeper, in any unit

/// Depth at which a pointed tool has cut this diameter.
double sink_depth(double diameter, double angle_deg) {
  return diameter / 2 / std::tan(units::rad_from_deg(angle_deg) / 2);
}

Outcome set_depth(const CycleWords& words, const HoleType& type, CycleStatement& out,
                  const DialectTraits& traits) {
  const bool is_sink = type.word == "CSINK" || words.has("CSINK") || !words.sink.empty();
  if (words.feed_to.size() == 2 && is_sink) {
    out.cycle.depth = sink_depth(words.feed_to[0], words.feed_to[1]);
  } else if (words.feed_to.size() == 1) {
    out.cycle.depth = std::abs(words.feed_to[0]);
    out.has_odd_sign = words.feed_to[0] != 0 && (words.feed_to[0] < 0) != traits.depth_is_negative;
  } else if (words.depth.size() == 1) {
    out.cycle.depth = std::abs(words.depth[0]);
    out.has_odd_sign = words.depth[0] < 0;
  } else if (words.sink.size() >= 2) {
    out.cycle.depth = sink_depth(words.sink[0], words.sink[1]);
  } else {
    return refuse("CYCLE gives no depth", "FEDTO or DEPTH with one number");
  }
  if (!(out.cycle.depth >= 0 && out.cycle.depth <= kLargest)) {
    return refuse("CYCLE: a depth of " + short_number(out.cycle.depth) + " makes no sense");
  }
  return {};
}

bool gives_retraction(const CycleWords& words) {
  return !words.retract_to.empty() || !words.return_to.empty() || words.returns_to_before;
}

/// Levels above the top. ISO 4343 and Creo count RAPTO down from CLEAR; the others up from the top.
Outcome set_levels(const CycleWords& words, CycleStatement& out) {
  HoleCycle& cycle = out.cycle;
  const bool is_iso = words.feed_to.empty() && !words.clear.empty();
  if (!is_iso && !words.clear.empty() && !gives_retraction(words)) {
    return refuse(
        "CYCLE gives CLEAR beside FEDTO: a level above the hole or a Z, as the writer means",
        "output RAPTO and RTRCTO, or let the CAM system write the cycle out as motion");
  }
  std::optional<double> retract;
  if (is_iso) {
    cycle.rapid_level = words.clear[0] - (words.rapid_to.empty() ? 0 : words.rapid_to[0]);
    retract = words.clear[0];
    if (!words.return_to.empty() && words.return_to[0] != 0) retract = words.return_to[0];
    if (!words.return_to.empty() && words.return_to[0] == 0) {
      cycle.returns = CycleReturn::kToBefore;  // the retract plane, from which the cycle began
    }
  } else if (!words.rapid_to.empty()) {
    cycle.rapid_level = words.rapid_to[0];
  } else {
    return refuse("CYCLE gives no level down to which the tool may move at rapid",
                  "RAPTO with one number");
  }
  if (!words.retract_to.empty()) retract = words.retract_to[0];
  if (!is_iso && !words.return_to.empty()) retract = words.return_to[0];
  if (words.returns_to_before) cycle.returns = CycleReturn::kToBefore;
  if (!(cycle.rapid_level >= 0 && cycle.rapid_level <= kLargest)) {
    return refuse("CYCLE: the rapid level lies " + short_number(cycle.rapid_level) +
                  " above the top of the hole: inside the part");
  }
  cycle.retract_level = std::max(retract.value_or(cycle.rapid_level), cycle.rapid_level);
  if (!(cycle.retract_level <= kLargest)) return refuse("CYCLE: the retract level makes no sense");
  return {};
}

Outcome set_pecks(const CycleWords& words, HoleCycle& cycle) {
  cycle.pecks = words.steps;
  if (!words.first_peck.empty()) cycle.pecks = words.first_peck;
  if (!words.next_peck.empty()) cycle.pecks.push_back(words.next_peck[0]);
  const bool needs = cycle.kind == HoleKind::kDeep || cycle.kind == HoleKind::kChipBreak;
  if (!needs) cycle.pecks.clear();
  if (needs && cycle.pecks.empty()) {
    return refuse("CYCLE drills in pecks and gives no peck", "STEP, INCR or 1STPECK");
  }
  const bool sound = std::all_of(cycle.pecks.begin(), cycle.pecks.end(),
                                 [&](double p) { return p > 0 && p >= cycle.depth * 1e-3; });
  if (!sound) return refuse("CYCLE: a peck of nothing, or more than 1000 pecks");
  if (!words.back.empty()) cycle.back = words.back[0];
  if (!words.times.empty())
    cycle.pecks_to_retract = static_cast<int>(std::min(words.times[0], 1e4));
  return {};
}

/// What words after the type make of it: DRILL,DEEP and BORE,DRAG.
Outcome set_kind(const CycleWords& words, const HoleType& type, HoleCycle& cycle) {
  cycle.kind = type.kind;
  cycle.ends_after_one = type.word == "MILL";
  if (words.has("DEEP")) cycle.kind = HoleKind::kDeep;
  if (words.has("BRKCHP")) cycle.kind = HoleKind::kChipBreak;
  for (const std::string_view word : {"NODRAG", "BACK", "ORIENT"}) {
    if (words.has(word)) {
      return refuse(
          "CYCLE/" + std::string(type.word) + "," + std::string(word) + " " + std::string(kOrient),
          "let the CAM system write the cycle out as motion");
    }
  }
  if (words.has("MANUAL") && type.word == "BORE") {
    return refuse("CYCLE/BORE,MANUAL " + std::string(kByHand));
  }
  if (words.has("DRAG")) cycle.kind = HoleKind::kStopOut;
  return {};
}

/// Depth, feed and clearance by their place, as HSM posts write them.
Outcome spread_positions(CycleWords& words, const DialectFinder& dialect, HoleCycle& cycle) {
  if (words.positions.empty()) return {};
  const CycleNumbers meaning = dialect.traits().cycle_numbers;
  if (meaning == CycleNumbers::kAsk) {
    return refuse(
        "CYCLE gives numbers by their place: what they mean stands in the table of a "
        "post-processor",
        "let the CAM system write keywords (FEDTO, RAPTO) or motion; depth, feed and clearance as "
        "the posts of HSM write them are read with --dialect fusion (its ISO 4343 post: points are "
        "bottoms of holes) or hsm (Generative Machining: tops)");
  }
  if (words.positions.size() != 2 || words.feeds.size() != 1) {
    return refuse("CYCLE needs depth, unit, feed and clearance in this order");
  }
  const double depth = words.positions[0], clearance = words.positions[1];
  words.depth = {depth};
  words.positions.clear();
  if (meaning == CycleNumbers::kDepthUnitFeed) {
    words.clear = {clearance - depth};
  } else {
    cycle.clearance_z = clearance;
    if (!words.rapid_to.empty()) cycle.rapid_below = words.rapid_to[0];
  }
  return {};
}

}  // namespace

std::span<const HoleType> hole_types() { return kTypes; }

Expected<CycleStatement, Refusal> read_cycle(const Statement& s, const DialectFinder& dialect) {
  CycleStatement out;
  const auto error = [](const Refusal& refusal) { return tl::make_unexpected(refusal); };
  if (s.argument_count == 0) return refuse("CYCLE without a type");
  if (s.fault != Statement::ArgumentFault::kNone) return refuse("CYCLE is not understood");
  out.type = s.arguments[0].text;
  const auto is_type = [&out](std::string_view word) { return is_word(out.type, word); };
  if (is_type("OFF") || is_type("NOMORE") || (s.argument_count == 2 && s.has_word("OFF"))) {
    out.kind = CycleStatement::Kind::kOff;
    return out;
  }
  if (s.argument_count == 1 && is_type("ON")) {
    out.kind = CycleStatement::Kind::kOn;
    return out;
  }
  if (s.argument_count == 1 && (is_type("INIT") || is_type("CLEAR"))) {
    out.kind = CycleStatement::Kind::kReturn;
    out.returns = is_type("INIT") ? CycleReturn::kToRetract : CycleReturn::kToRapidLevel;
    return out;
  }
  const auto type = std::find_if(kTypes.begin(), kTypes.end(),
                                 [&](const HoleType& row) { return is_type(row.word); });
  if (type == kTypes.end() || !type->refusal.empty()) {
    return refuse("CYCLE/" + std::string(out.type) + " " +
                      std::string(type == kTypes.end() ? kControl : type->refusal),
                  "let the CAM system write the cycle out as motion");
  }
  auto words = read_cycle_words(s);
  if (!words) return error(words.error());
  if (auto done = spread_positions(*words, dialect, out.cycle); !done) return error(done.error());
  if (words->feeds.size() > 1) return refuse("CYCLE gives several feeds");
  if (!words->feeds.empty()) out.cycle.feed = words->feeds[0];
  out.cycle.dwell_s = words->dwell_s;
  out.cycle.dwell_revolutions = words->dwell_revolutions;
  if (auto done = set_kind(*words, *type, out.cycle); !done) return error(done.error());
  if (auto done = set_depth(*words, *type, out, dialect.traits()); !done)
    return error(done.error());
  if (!out.cycle.clearance_z) {
    if (auto done = set_levels(*words, out); !done) return error(done.error());
  } else if (gives_retraction(*words) || !words->clear.empty()) {
    return refuse("CYCLE gives a clearance by its position and by a word",
                  "let the CAM system write the cycle out as motion");
  }
  if (auto done = set_pecks(*words, out.cycle); !done) return error(done.error());
  return out;
}

}  // namespace meridian::cl
