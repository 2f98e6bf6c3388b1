// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/words/motion.hpp"
#include "service/programs/nc/remedy.hpp"
#include "service/programs/nc/state.hpp"
#include "service/programs/nc/words/turn.hpp"

namespace meridian::nc {

using cl::refuse;

namespace {

Vector3 tip_of(const ToolPosition& position) {
  return {*position.tip[0], *position.tip[1], *position.tip[2]};
}

/// Into how many blocks of ours a block with rotary words is cut.
Expected<int, cl::Refusal> pieces_of(State& s, const Target& to) {
  const bool is_known =
      s.position.is_known() && s.cl.path.position() == cl::BlockPath::Position::kReached;
  const bool is_swept = s.modes.control == Control::kRotary && s.modes.turns_evenly();
  if (!is_swept || !to.turns || !is_known) return 1;
  if (largest_turn_deg(s.position.rotary, to.position.rotary) > kMaxTurn_deg) {
    return refuse("more than a hundred turns of a rotary axis in one block", kMovesByCam);
  }
  const int pieces =
      pieces_of_turn(*s.axes, s.position.rotary, to.position.rotary, s.axes->axis_tolerance_rad());
  if (pieces > 1) {
    ++s.cl.summary.nc.turned_blocks;
    s.cl.summary.nc.turned_pieces += static_cast<std::uint64_t>(pieces);
  }
  return pieces;
}

}  // namespace

Expected<ToolPose, cl::Refusal> in_path(const State& s, const PathEnd& end) {
  const Vector3 from_zero = direction_in_w(s, in_program(s, end.tip));
  const auto tip = cl::point_in_w(s.cl, from_zero.data());
  if (!tip) return tl::make_unexpected(tip.error());
  return ToolPose{*tip, s.cl.frames.direction(end.axis)};
}

Expected<cl::MotionFeed, cl::Refusal> feed_of_motion(State& s, const Line& line) {
  if (s.modes.motion == Motion::kRapid) {
    return cl::MotionFeed{BlockKind::kRapid, FeedMeaning::kNone, 0};
  }
  const cl::FeedUnit unit = s.modes.feed_unit;
  if (unit == cl::FeedUnit::kInverseTime && line.find("F") == nullptr) {
    return refuse("under G93 every cutting block needs its own F", "write F in each, or G94",
                  "no F");
  }
  if (s.cl.written_feed.unit == cl::FeedUnit::kNone && !s.cl.options.default_feed_mm_per_s) {
    return refuse("cutting motion, but no F before it", "--feed MM_PER_MIN", "no F");
  }
  if (unit == cl::FeedUnit::kPerRevolution && !s.cl.spindle.turns()) {
    return refuse("feed per revolution (G95), but no spindle speed is in force",
                  "write S and M3 or M4 before it", "G95");
  }
  return cl::cutting_feed(s.cl, line.number);
}

cl::Outcome line_to(State& s, const Line& line, const Target& to) {
  auto feed = feed_of_motion(s, line);
  if (!feed) return tl::make_unexpected(feed.error());
  const auto pieces = pieces_of(s, to);
  if (!pieces) return tl::make_unexpected(pieces.error());
  if (feed->meaning == FeedMeaning::kInverseTime) feed->feed *= *pieces;
  const Vector3 end = tip_of(to.position);
  for (int n = 1; n <= *pieces; ++n) {
    const double share = static_cast<double>(n) / *pieces;
    PathEnd at{end, to.axis};
    if (n < *pieces) {
      const Vector3 begin = tip_of(s.position);
      at = {begin + share * (end - begin),
            s.axes->axis(between(s.position.rotary, to.position.rotary, share))};
    }
    const auto pose = in_path(s, at);
    if (!pose) return tl::make_unexpected(pose.error());
    if (auto done = s.cl.path.line_to(pose->tip, pose->axis, *feed, line.number); !done) {
      return done;
    }
  }
  s.position = to.position;
  s.in_w = {in_w(s, end), to.axis};
  return {};
}

}  // namespace meridian::nc
