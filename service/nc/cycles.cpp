// SPDX-License-Identifier: Apache-2.0
// Canned cycles of Fanuc words, as the holes of a CL file: along the tool axis, from R down to Z.
#include <algorithm>
#include <array>

#include "service/cl/words/motion.hpp"
#include "service/cl/written_text.hpp"
#include "service/nc/state.hpp"

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
cl::Outcome take_place(State& s, const Line& line) {
  for (std::size_t k = 0; k < 2; ++k) {
    const Word* const word = line.find(k == 0 ? "X" : "Y");
    std::optional<double>& at = s.place.tip[k];
    if (word != nullptr) at = s.modes.is_incremental && at ? *at + word->number : word->number;
    s.cl.summary.decimals =
        std::max(s.cl.summary.decimals, word != nullptr ? word->decimals : std::uint8_t{0});
  }
  return {};
}

/// The tool axis of a hole, along the axes of the program's zero.
Vector3 tool_axis(const State& s) {
  return is_across_plane(s, s.place) ? tool_of_plane(s) : Vector3(Vector3::UnitZ());
}

cl::Outcome check_state(const State& s, const Line& line) {
  constexpr double kSameAxis = 1e-6;
  const bool is_turned = s.place.is_turned() && !is_across_plane(s, s.place);
  const bool is_along = (s.frames.now.rotation.col(2) - tool_axis(s)).norm() < kSameAxis;
  if (holds_tip(s.modes.control) || is_turned || !is_along || s.modes.plane != 2) {
    return refuse("a canned cycle with tool-centre control, turned axes or outside G17",
                  "let the CAM system write the moves themselves", "cycle");
  }
  if (!s.place.is_known() || !s.cl.path.has_moved()) {
    return refuse("a canned cycle, but where the tool stands is not known here",
                  "write a G0 with X, Y and Z before it", "not known");
  }
  if (s.modes.feed_unit == cl::FeedUnit::kInverseTime) {
    return refuse("a canned cycle under G93", "write G94");
  }
  for (const char* const address : {"A", "B", "C", "I", "J"}) {
    if (line.find(address) != nullptr) {
      return refuse(std::string("word ") + address + " in a canned cycle is not understood");
    }
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
    cycle.initial = s.place.tip[2].value_or(0);
  }
  cycle.code = static_cast<std::uint8_t>(code);
}

cl::Outcome run_cycle(State& s, const Line& line) {
  if (auto done = check_state(s, line); !done) return done;
  Cycle& cycle = s.modes.cycle;
  if (auto done = take_words(cycle, line, s.modes.is_incremental); !done) return done;
  for (const char* const address : {"K", "L"}) {
    const Word* const repeats = line.find(address);
    if (repeats == nullptr || repeats->number == 1) continue;
    if (repeats->number == 0) return {};  // the cycle is only told
    return refuse(std::string(address) + std::string(repeats->digits) + " repeats of a cycle",
                  "write every hole as a block");
  }
  if (auto done = cl::begin_motion(s.cl, line.number); !done) return done;
  if (auto done = take_place(s, line); !done) return done;
  s.modes.motion = Motion::kLine;
  if (const auto feed = feed_of_motion(s, line); !feed) return tl::make_unexpected(feed.error());
  const auto hole = hole_of(cycle);
  if (!hole) return tl::make_unexpected(hole.error());
  const Vector3 up = direction_in_w(s, tool_axis(s));
  const Vector3 top{*s.place.tip[0], *s.place.tip[1], *cycle.r};
  const auto pose = in_path(s, {top, up});
  if (!pose) return tl::make_unexpected(pose.error());
  for (const double level : {*cycle.z, cycle.initial}) {
    const auto end = in_path(s, {Vector3(top[0], top[1], level), up});
    if (!end) return tl::make_unexpected(end.error());
  }
  s.cl.axis.written = to_array(up);
  s.cl.axis.in_w = pose->axis;
  s.cl.cycle = *hole;
  auto done = cl::run_hole(s.cl, pose->tip, line.number);
  s.cl.cycle.reset();
  if (!done) return done;
  const Vector3 end = top + Vector3(0, 0, hole->retract_level);
  s.place.tip[2] = end[2];
  s.in_w = {in_w(s, end), up};
  return {};
}

}  // namespace meridian::nc
