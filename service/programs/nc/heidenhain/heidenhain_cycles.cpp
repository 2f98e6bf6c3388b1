// SPDX-License-Identifier: Apache-2.0
// Drilling cycles of Klartext: lengths count from the workpiece surface Q203.
#include "service/programs/nc/heidenhain/heidenhain_cycles.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "service/programs/cl/text/number.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/heidenhain/heidenhain_frames.hpp"
#include "service/programs/nc/heidenhain/heidenhain_parameters.hpp"
#include "service/programs/nc/heidenhain/heidenhain_words.hpp"
#include "service/programs/nc/remedy.hpp"

namespace meridian::nc {
namespace {

using cl::HoleKind;
using cl::refuse;

/// Q parameters that the cycles share.
constexpr int kQClearance = 200, kQDepth = 201, kQPeck = 202, kQSurface = 203,
              kQSecondClearance = 204, kQMinPeck = 205, kQFeed = 206, kQFeedOut = 208,
              kQDwell = 211, kQDecrement = 212, kQBreaks = 213, kQBack = 256, kQBreakDepth = 257,
              kQByDiameter = 343, kQStartDepth = 379, kQDepthOfShank = 395;
constexpr int kPreset247 = 247, kQPreset = 339;
/// A feed that stands for rapid.
constexpr double kRapidFeed = 99999;

struct KlartextRow {
  int number;
  HoleKind kind;
  bool has_pecks;
};

constexpr std::array kKlartextCycles = std::to_array<KlartextRow>({{200, HoleKind::kDeep, true},
                                                                   {201, HoleKind::kFeedOut, false},
                                                                   {203, HoleKind::kDeep, true},
                                                                   {205, HoleKind::kDeep, true},
                                                                   {240, HoleKind::kDrill, false}});

const KlartextRow* find_klartext_cycle(int number) {
  const auto at = std::find_if(kKlartextCycles.begin(), kKlartextCycles.end(),
                               [number](const KlartextRow& row) { return row.number == number; });
  return at == kKlartextCycles.end() ? nullptr : &*at;
}

std::string title_of(const CycleDefinition& cycle) {
  return "CYCL DEF " + std::to_string(cycle.number);
}

cl::Refusal refusal_of(const CycleDefinition& cycle, const std::string& why) {
  return {title_of(cycle) + why, kMovesByCam, title_of(cycle), 0};
}

double value_of(const CycleDefinition& cycle, int parameter) {
  const auto at = cycle.parameters.find(parameter);
  return at == cycle.parameters.end() ? 0 : at->second;
}

/// What these ask for is not run here; nothing is asked where they are zero or left out.
cl::Outcome check_left_out(const CycleDefinition& cycle) {
  constexpr std::array kNotRun = {kQByDiameter, kQBreakDepth, kQStartDepth, kQDepthOfShank};
  for (const int parameter : kNotRun) {
    if (value_of(cycle, parameter) == 0) continue;
    return tl::make_unexpected(
        refusal_of(cycle, " with Q" + std::to_string(parameter) + " other than 0"));
  }
  for (const int parameter : {kQClearance, kQDepth, kQSurface}) {
    if (cycle.parameters.contains(parameter)) continue;
    return tl::make_unexpected(refusal_of(cycle, " without Q" + std::to_string(parameter)));
  }
  return {};
}

/// Each peck is shorter than the one before by Q212, down to Q205.
std::vector<double> klartext_pecks(const CycleDefinition& cycle, double depth) {
  constexpr std::size_t kMaxPecks = 10000;
  const double decrement = std::max(value_of(cycle, kQDecrement), 0.0);
  std::vector<double> pecks;
  double peck = value_of(cycle, kQPeck);
  const double min = std::max({value_of(cycle, kQMinPeck), depth / kMaxPecks});
  for (double left = depth; peck > 0 && left > 0 && pecks.size() < kMaxPecks;) {
    pecks.push_back(peck);
    left -= peck;
    if (decrement > 0) peck = std::max(peck - decrement, std::min(min, peck));
  }
  return pecks;
}

cl::Outcome add_klartext_pecks(const CycleDefinition& cycle, cl::HoleCycle& hole) {
  const double peck = value_of(cycle, kQPeck);
  if (!(peck > hole.depth * 1e-4)) {
    return tl::make_unexpected(refusal_of(cycle, " without a plunging depth Q202"));
  }
  hole.pecks = klartext_pecks(cycle, hole.depth);
  const double breaks = cycle.number == 203 ? value_of(cycle, kQBreaks) : 0;
  if (breaks > 0) {
    hole.kind = HoleKind::kChipBreak;
    hole.pecks_to_retract = static_cast<int>(std::min(breaks, 1e4)) + 1;
    hole.back = value_of(cycle, kQBack);
  }
  return {};
}

Expected<Drilling, cl::Refusal> drilling_of(const CycleDefinition& cycle) {
  if (auto done = check_left_out(cycle); !done) return tl::make_unexpected(done.error());
  const KlartextRow& row = *find_klartext_cycle(cycle.number);
  Drilling out;
  out.top = value_of(cycle, kQSurface);
  cl::HoleCycle& hole = out.hole;
  hole.kind = row.kind;
  hole.depth = -value_of(cycle, kQDepth);
  hole.rapid_level = value_of(cycle, kQClearance);
  hole.retract_level = std::max(value_of(cycle, kQSecondClearance), hole.rapid_level);
  hole.dwell_s = value_of(cycle, kQDwell);
  hole.dwells_at_pecks = false;
  if (!(hole.depth > 0) || hole.rapid_level < 0) {
    return tl::make_unexpected(refusal_of(cycle, ": the depth Q201 has to be below zero"));
  }
  if (value_of(cycle, kQFeed) > 0) {
    hole.feed = {value_of(cycle, kQFeed), cl::FeedUnit::kMillimetrePerMinute};
  }
  if (cycle.parameters.contains(kQFeedOut)) {
    const double feed_out = value_of(cycle, kQFeedOut);
    if (feed_out == 0) hole.feed_out = hole.feed;
    if (feed_out > 0 && feed_out < kRapidFeed) {
      hole.feed_out = {feed_out, cl::FeedUnit::kMillimetrePerMinute};
    }
  }
  if (row.has_pecks) {
    if (auto done = add_klartext_pecks(cycle, hole); !done)
      return tl::make_unexpected(done.error());
  }
  return out;
}

/// The next of Q201=-20: parameter, value; the point may be a comma.
bool take_parameter(std::string_view& text, const Variables& variables, int& parameter,
                    double& value) {
  const std::size_t equals = text.find('=');
  double number = 0;
  if (!text.starts_with('Q') || equals == std::string_view::npos ||
      !cl::parse_number(text.substr(1, equals - 1), number) || number < 1 || number > 9999) {
    return false;
  }
  parameter = static_cast<int>(number);
  text.remove_prefix(equals + 1);
  while (text.starts_with(' ')) text.remove_prefix(1);
  const std::size_t size = std::min(text.find_first_of(" ~\t"), text.size());
  const std::string_view written = text.substr(0, size);
  text.remove_prefix(size);
  const auto read = written == "FMAX" ? kRapidFeed : read_number(written, variables);
  value = read.value_or(0);
  return read.has_value();
}

/// M8 beside CYCL CALL. False: it is none that may stand there.
bool take_action(Line& actions, std::string_view written) {
  constexpr std::array<double, 8> kActions = {3, 4, 5, 7, 8, 9, 13, 14};
  double code = 0;
  const bool is_code = written.starts_with('M') && cl::parse_number(written.substr(1), code) &&
                       std::find(kActions.begin(), kActions.end(), code) != kActions.end();
  if (!is_code) return false;
  Word word;
  word.number = code;
  if (code == 13 || code == 14) {
    move_start_with_coolant(actions, word);
  } else {
    move_word(actions, word, "M");
  }
  return true;
}

}  // namespace

cl::Outcome take_cycle_parameters(State& s, const Line& line, std::string_view text) {
  const auto skip = [&text] {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t' || text.front() == '~')) {
      text.remove_prefix(1);
    }
  };
  const bool is_of_cycle = s.modes.open == OpenDefinition::kCycle;
  if (is_of_cycle && std::holds_alternative<RefusedCycle>(s.modes.definition)) return {};
  auto* const cycle = is_of_cycle ? std::get_if<CycleDefinition>(&s.modes.definition) : nullptr;
  for (skip(); !text.empty(); skip()) {
    int parameter = 0;
    double value = 0;
    const std::string_view from = text;
    if (s.modes.open == OpenDefinition::kNone ||
        !take_parameter(text, s.variables, parameter, value)) {
      return refuse("a Q parameter: " + cl::quoted(from.substr(0, 16)), kMovesByCam, "Q");
    }
    if (cycle != nullptr) {
      cycle->parameters[parameter] = value;
    } else if (parameter == kQPreset) {
      auto done = activate_preset(s, line, value, "CYCL DEF 247 with Q339");
      if (!done) return done;
    }
  }
  return {};
}

cl::Outcome define_cycle(State& s, const Line& line, std::string_view number,
                         std::string_view text) {
  double value = 0;
  const bool is_number = cl::parse_number(number, value) && value > 0 && value < 1000;
  const bool is_preset = is_number && value == kPreset247;
  const bool is_drilling =
      is_number && value == std::floor(value) && find_klartext_cycle(static_cast<int>(value));
  if (!is_drilling && !is_preset) {
    s.modes.definition = RefusedCycle{};
    s.modes.open = OpenDefinition::kCycle;
    return refuse("CYCL DEF " + std::string(number.substr(0, 16)) + ": a cycle of the control",
                  kMovesByCam, "CYCL DEF");
  }
  s.modes.open = is_preset ? OpenDefinition::kPreset : OpenDefinition::kCycle;
  if (is_drilling) s.modes.definition = CycleDefinition{static_cast<int>(value), {}};
  const std::size_t first = text.find(" Q");
  if (first == std::string_view::npos) return {};
  return take_cycle_parameters(s, line, text.substr(first));
}

cl::Outcome call_cycle(State& s, const Line& line) {
  if (std::holds_alternative<RefusedCycle>(s.modes.definition)) return {};  // where it was defined
  const auto* const cycle = std::get_if<CycleDefinition>(&s.modes.definition);
  if (cycle == nullptr) {
    return refuse("a cycle is called, but no CYCL DEF that is run here stands before it",
                  kMovesByCam, "CYCL CALL");
  }
  const auto drilling = drilling_of(*cycle);
  if (!drilling) return tl::make_unexpected(drilling.error());
  return drill(s, line, *drilling);
}

cl::Outcome run_cycle_call(State& s, const Line& line) {
  std::string_view text = line.names.front().arguments;
  Line actions;
  actions.number = line.number;
  while (text.find_first_not_of(' ') != std::string_view::npos) {
    text.remove_prefix(text.find_first_not_of(' '));
    const std::string_view written = text.substr(0, text.find(' '));
    text.remove_prefix(written.size());
    if (written == "FMAX") continue;
    if (take_action(actions, written)) continue;
    return refuse(
        "CYCL CALL" + std::string(line.names.front().arguments.substr(0, 16)) + " is not run here",
        kMovesByCam, "CYCL CALL");
  }
  if (auto done = act_before(s, actions); !done) return done;
  if (auto done = call_cycle(s, line); !done) return done;
  return act_after(s, actions);
}

}  // namespace meridian::nc
