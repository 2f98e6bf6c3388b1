// SPDX-License-Identifier: Apache-2.0
// Canned cycles of Fanuc words, as the holes of a CL file: along the tool axis, from R down to Z.
#include <algorithm>
#include <array>

#include "service/programs/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::HoleKind;
using cl::refuse;

struct CycleRow {
  std::uint8_t code;  ///< of G
  HoleKind kind;
  bool has_pecks, has_dwell;
};

constexpr std::array kCycles = std::to_array<CycleRow>({{73, HoleKind::kChipBreak, true, false},
                                                        {81, HoleKind::kDrill, false, false},
                                                        {82, HoleKind::kDrill, false, true},
                                                        {83, HoleKind::kDeep, true, false},
                                                        {85, HoleKind::kFeedOut, false, false},
                                                        {86, HoleKind::kStopOut, false, false},
                                                        {89, HoleKind::kFeedOut, false, true}});

/// Z, R, Q and P hold until the cycle ends.
cl::Outcome take_words(Cycle& cycle, const Line& line, bool is_incremental) {
  const auto take = [&](std::string_view address, std::optional<double>& to) {
    const Word* const word = line.find(address);
    if (word != nullptr) to = word->number;
    return word != nullptr;
  };
  const bool has_r = take("R", cycle.r), has_z = take("Z", cycle.z);
  if (is_incremental && has_r) *cycle.r += cycle.initial;
  if (is_incremental && has_z && cycle.r) *cycle.z += *cycle.r;
  (void)take("Q", cycle.peck);
  if (const Word* const p = line.find("P"); p != nullptr) {
    cycle.dwell_s = p->has_point ? p->number : p->number / 1000;
  }
  if (!cycle.r || !cycle.z) return refuse("a canned cycle needs R and Z", {}, "cycle");
  if (!(*cycle.z < *cycle.r)) {
    return refuse("a canned cycle whose Z is not below its R", {}, "cycle");
  }
  return {};
}

Expected<cl::HoleCycle, cl::Refusal> hole_of(const Cycle& cycle) {
  const auto row = std::find_if(kCycles.begin(), kCycles.end(),
                                [&](const CycleRow& r) { return r.code == cycle.code; });
  cl::HoleCycle hole;
  hole.kind = row->kind;
  hole.depth = *cycle.r - *cycle.z;
  hole.retract_level = cycle.returns_to_r ? 0 : std::max(cycle.initial - *cycle.r, 0.0);
  if (row->has_dwell) hole.dwell_s = cycle.dwell_s;
  if (row->has_pecks) {
    if (!cycle.peck || !(*cycle.peck > hole.depth * 1e-4)) {
      return refuse("a cycle in pecks needs their depth Q", {}, "cycle Q");
    }
    hole.pecks = {*cycle.peck};
  }
  return hole;
}

/// Where the tool stands over the hole: X and Y of the line.
cl::Outcome take_position(State& s, const Line& line) {
  for (std::size_t k = 0; k < 2; ++k) {
    const Word* const word = line.find(k == 0 ? "X" : "Y");
    std::optional<double>& at = s.position.tip[k];
    if (word != nullptr) at = s.modes.is_incremental() && at ? *at + word->number : word->number;
    s.cl.summary.decimals =
        std::max(s.cl.summary.decimals, word != nullptr ? word->decimals : std::uint8_t{0});
  }
  return {};
}

}  // namespace

void begin_cycle(State& s, int code) {
  Cycle& cycle = s.modes.cycle;
  if (code != 0 && cycle.code == 0) {
    const bool returns_to_r = cycle.returns_to_r;
    cycle = {};
    cycle.returns_to_r = returns_to_r;
    cycle.initial = s.position.tip[2].value_or(0);
  }
  cycle.code = static_cast<std::uint8_t>(code);
}

cl::Outcome run_cycle(State& s, const Line& line) {
  if (auto done = check_hole(s); !done) return done;
  for (const char* const address : {"A", "B", "C", "I", "J"}) {
    if (line.find(address) != nullptr) {
      return refuse(std::string("word ") + address + " in a canned cycle is not understood");
    }
  }
  Cycle& cycle = s.modes.cycle;
  if (auto done = take_words(cycle, line, s.modes.is_incremental()); !done) return done;
  for (const char* const address : {"K", "L"}) {
    const Word* const repeats = line.find(address);
    if (repeats == nullptr || repeats->number == 1) continue;
    if (repeats->number == 0 && (line.find("X") != nullptr || line.find("Y") != nullptr)) {
      return refuse(std::string(address) + "0 beside X or Y: whether the tool goes there differs",
                    "write the cycle without X and Y, and every hole as a block", "cycle K0");
    }
    if (repeats->number == 0) return {};  // the cycle is only defined
    return refuse(std::string(address) + std::string(repeats->digits) + " repeats of a cycle",
                  "write every hole as a block");
  }
  if (auto done = take_position(s, line); !done) return done;
  s.modes.motion = Motion::kLine;
  const auto hole = hole_of(cycle);
  if (!hole) return tl::make_unexpected(hole.error());
  return drill(s, line, {*hole, *cycle.r});
}

}  // namespace meridian::nc
