// SPDX-License-Identifier: Apache-2.0
// G28, G30 and G53: single axes go to positions of the machine itself.
#include <algorithm>
#include <array>

#include "meridian/units.hpp"
#include "service/programs/cl/words/motion.hpp"
#include "service/programs/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

bool is_axis_word(const Word& word) {
  const char c = word.address.front();
  return (c >= 'X' && c <= 'Z') || word.may_be_rotary();
}

bool is_linear(const Word& word) { return word.address.front() >= 'X'; }

/// Before the first motion nothing is known of where the tool is, and nothing has to be. Rotary
/// axes stand where they were sent, as far as the machine is known.
void move_unseen(State& s, const std::vector<MachineAxes::Target>& targets,
                 const MachineAxes* known) {
  s.position.forget();
  for (const MachineAxes::Target& target : targets) {
    if (target.address.front() >= 'X') continue;
    std::erase_if(s.position.rotary,
                  [&](const RotaryAt& at) { return at.address == target.address; });
    const auto deg = known != nullptr ? known->word_at(target) : target.value;
    s.position.rotary.push_back({std::string(target.address), deg});
  }
}

cl::Outcome check_intermediate(const State& s, const Line& line, const char* code) {
  for (const Word& word : line.words) {
    if (!is_axis_word(word) || (s.modes.is_incremental() && word.number == 0)) continue;
    return refuse(std::string(code) + " by way of a point between",
                  std::string("write G91 ") + code + " with zeros, such as G91 " + code + " Z0.");
  }
  return {};
}

/// "G30", "G30 P3": how the machine file calls the position.
std::string name_of_reference(const Line& line) {
  const Word* const p = line.find("P");
  const bool is_second = p == nullptr || p->number == 2;
  return is_second ? "G30" : "G30 P" + std::string(p->digits);
}

const char* code_of(const State& s, MachinePosition position) {
  if (position == MachinePosition::kHome) return "G28";
  if (position == MachinePosition::kReference) return "G30";
  if (s.modes.language == Language::kSiemens) return "SUPA";
  return s.modes.language == Language::kHeidenhain ? "M91" : "G53";
}

std::vector<MachineAxes::Target> targets_of(const State& s, const Line& line, bool is_as_written) {
  std::vector<MachineAxes::Target> targets;
  for (const Word& word : line.words) {
    if (!is_axis_word(word)) continue;
    MachineAxes::Target target{word.address, std::nullopt, nullptr};
    if (is_as_written) target.value = word.number * (is_linear(word) ? s.cl.units.to_mm : 1);
    targets.push_back(target);
  }
  return targets;
}

cl::Outcome lead_to_reference(const State& s, const Line& line,
                              std::vector<MachineAxes::Target>& targets) {
  const std::string name = name_of_reference(line);
  const auto at = s.cl.options.positions.find(name);
  if (at == s.cl.options.positions.end()) {
    return refuse("G30: a reference position that the machine file does not have",
                  "[[position]] with name = \"" + name + "\"", "G30");
  }
  for (MachineAxes::Target& target : targets) target.position = &at->second;
  return {};
}

}  // namespace

cl::Outcome move_to_machine_position(State& s, const Line& line, MachinePosition position) {
  const bool is_as_written = position == MachinePosition::kAsWritten;
  const char* const code = code_of(s, position);
  if (auto done = cl::begin_motion(s.cl, line.number); !done) return done;
  std::vector<MachineAxes::Target> targets = targets_of(s, line, is_as_written);
  if (targets.empty()) {
    return refuse(std::string(code) +
                      " without axis words moves all axes on some controls and "
                      "none on others",
                  std::string("write which, such as G91 ") + code + " Z0.", code);
  }
  const bool turns = std::any_of(line.words.begin(), line.words.end(),
                                 [](const Word& word) { return word.may_be_rotary(); });
  if (turns && s.modes.has_dynamic_offset) {
    return refuse(std::string(code) + " with rotary words under G254", "write G255 before it");
  }
  if (!is_as_written) {
    if (auto done = check_intermediate(s, line, code); !done) return done;
  } else if (s.modes.is_incremental() || s.modes.motion > Motion::kLine) {
    return refuse(std::string(code) + " needs G90, and G0 or G1", "write both before it");
  }
  const bool is_unseen = !s.cl.path.has_moved();
  if (!s.axes && !is_unseen) {
    return refuse(std::string(code) + " moves to a place of the machine, which is not known here",
                  "--machine FILE", "machine");
  }
  cl::Outcome led;
  if (position == MachinePosition::kReference) led = lead_to_reference(s, line, targets);
  if (is_unseen) {
    move_unseen(s, targets, s.axes && led ? s.axes.get() : nullptr);
    return {};
  }
  if (!led) return led;
  if (s.cl.path.position() == cl::BlockPath::Position::kLost) {
    s.position.forget();
    return {};
  }
  const auto reached = s.axes->move(s.in_w, s.position.rotary, s.cl.tool, targets);
  if (!reached) return tl::make_unexpected(reached.error());
  s.cl.remarks.warn(code, line.number, [code] {
    return std::string(code) +
           ": a straight rapid to where the machine file has that place; see that nothing is in "
           "the way";
  });
  if (s.modes.language == Language::kSiemens && s.modes.control == Control::kLength) {
    s.cl.remarks.warn("SUPA and D", line.number, [] {
      return std::string(
          "SUPA with a tool offset in force: taken as a position of the spindle; where machine "
          "data $MN_G53_TOOLCORR is 0 the control adds the length of the tool");
    });
  }
  const Vector3 written = as_written(s, reached->pose.tip);
  const auto pose = in_path(s, {written, reached->pose.axis.normalized()});
  if (!pose) return tl::make_unexpected(pose.error());
  s.in_w = reached->pose;
  s.position.rotary = reached->rotary;
  s.position.is_by_control = false;
  if (turns) note_rotary_words(s, s.position);
  s.position.forget();
  if (!s.position.is_turned() || holds_tip(s.modes.control) || is_across_plane(s, s.position)) {
    for (std::size_t k = 0; k < 3; ++k) s.position.tip[k] = written[static_cast<Eigen::Index>(k)];
  }
  return s.cl.path.line_to(pose->tip, pose->axis, {BlockKind::kRapid, FeedMeaning::kNone, 0},
                           line.number);
}

}  // namespace meridian::nc
