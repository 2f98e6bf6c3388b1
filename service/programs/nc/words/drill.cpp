// SPDX-License-Identifier: Apache-2.0
// One hole of a canned cycle, in whatever language it is written.
#include <algorithm>

#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/cl/words/motion.hpp"
#include "service/programs/nc/remedy.hpp"
#include "service/programs/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

/// The tool axis of a hole, along the axes of the program's zero.
Vector3 tool_axis(const State& s) {
  return is_across_plane(s, s.position) ? tool_of_plane(s) : Vector3(Vector3::UnitZ());
}

/// The feed in force, where the cycle has none of its own.
cl::Outcome check_feed(State& s, const Line& line, const cl::HoleCycle& hole) {
  if (hole.feed.unit != cl::FeedUnit::kNone) return {};
  const Motion before = s.modes.motion;
  s.modes.motion = Motion::kLine;
  const auto feed = feed_of_motion(s, line);
  s.modes.motion = before;
  if (!feed) return tl::make_unexpected(feed.error());
  return {};
}

}  // namespace

cl::Outcome check_hole(const State& s) {
  constexpr double kSameAxis = 1e-6;
  const bool is_turned = s.position.is_turned() && !is_across_plane(s, s.position);
  const bool is_along = (s.frames.now.rotation.col(2) - tool_axis(s)).norm() < kSameAxis;
  if (holds_tip(s.modes.control) || is_turned || !is_along || s.modes.plane != 2) {
    return refuse("a canned cycle with tool-centre control, turned axes or outside G17",
                  kMovesByCam, "cycle");
  }
  if (!s.position.is_known() || !s.cl.path.has_moved()) {
    return refuse("a canned cycle, but where the tool stands is not known here",
                  "write a G0 with X, Y and Z before it", "not known");
  }
  if (s.modes.feed_unit == cl::FeedUnit::kInverseTime) {
    return refuse("a canned cycle under G93", "write G94");
  }
  return {};
}

cl::Outcome drill(State& s, const Line& line, const Drilling& drilling) {
  const cl::HoleCycle& hole = drilling.hole;
  if (auto done = check_hole(s); !done) return done;
  if (auto done = check_work_offset(s, line); !done) return done;
  if (auto done = cl::begin_motion(s.cl, line.number); !done) return done;
  if (auto done = check_feed(s, line, hole); !done) return done;
  const Vector3 up = direction_in_w(s, tool_axis(s));
  const Vector3 top{*s.position.tip[0], *s.position.tip[1], drilling.top};
  const auto pose = in_path(s, {top, up});
  if (!pose) return tl::make_unexpected(pose.error());
  const double out = std::max(hole.retract_level, hole.rapid_level);
  for (const double level : {-hole.depth, out}) {
    const auto end = in_path(s, {top + Vector3(0, 0, level), up});
    if (!end) return tl::make_unexpected(end.error());
  }
  s.cl.axis.written = to_array(up);
  s.cl.axis.in_w = pose->axis;
  s.cl.cycle = hole;
  auto done = cl::run_hole(s.cl, pose->tip, line.number);
  s.cl.cycle.reset();
  if (!done) return done;
  const Vector3 end = top + Vector3(0, 0, out);
  s.position.tip[2] = end[2];
  s.in_w = {in_w(s, end), up};
  return {};
}

}  // namespace meridian::nc
