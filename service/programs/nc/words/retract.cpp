// SPDX-License-Identifier: Apache-2.0
// M140 of Klartext: off the part along the tool axis.
#include <algorithm>

#include "service/programs/cl/words/motion.hpp"
#include "service/programs/nc/remedy.hpp"
#include "service/programs/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

/// How far, in mm: as given, or to the end of travel.
Expected<double, cl::Refusal> length_of(State& s, const Line& line, std::optional<double> given) {
  if (given) {
    if (!(*given >= 0)) return refuse("M140 into the part: MB is below zero", kMovesByCam);
    return *given * s.cl.units.to_mm;
  }
  if (!s.axes) {
    return refuse("M140 MB MAX goes to the end of travel of the machine, which is not known here",
                  "--machine FILE", "machine");
  }
  s.cl.remarks.warn("M140", line.number, [] {
    return std::string("M140 MB MAX: taken along the tool axis to the end of travel");
  });
  return s.axes->retract_travel(s.in_w, s.position.rotary, s.cl.tool);
}

}  // namespace

cl::Outcome retract(State& s, const Line& line, std::optional<double> distance) {
  if (auto done = cl::begin_motion(s.cl, line.number); !done) return done;
  const bool is_lost = s.cl.path.position() == cl::BlockPath::Position::kLost;
  if (!s.cl.path.has_moved() || is_lost || !s.position.is_known()) {
    if (s.cl.path.has_moved() && !is_lost) warn_of_unseen_rapid(s, line);
    s.position.forget();
    return {};
  }
  if (line.find("F") == nullptr) s.modes.motion = Motion::kRapid;
  const auto feed = feed_of_motion(s, line);
  if (!feed) return tl::make_unexpected(feed.error());
  const auto length_mm = length_of(s, line, distance);
  if (!length_mm) return tl::make_unexpected(length_mm.error());
  const ToolPose end{s.in_w.tip + *length_mm * s.in_w.axis, s.in_w.axis};
  const Vector3 written = as_written(s, end.tip);
  const auto pose = in_path(s, {written, end.axis});
  if (!pose) return tl::make_unexpected(pose.error());
  for (std::size_t k = 0; k < 3; ++k) s.position.tip[k] = written[static_cast<Eigen::Index>(k)];
  s.in_w = end;
  return s.cl.path.line_to(pose->tip, pose->axis, *feed, line.number);
}

}  // namespace meridian::nc
