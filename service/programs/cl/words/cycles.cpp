// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "meridian/units.hpp"
#include "service/programs/cl/shapes/hole.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/cl/words/handlers.hpp"
#include "service/programs/cl/words/motion.hpp"
#include "service/programs/cl/words/unit_by_feed.hpp"

namespace meridian::cl {
namespace {

constexpr double kLevelTolerance_mm = 1e-3;  // the last digit that CAM systems write
constexpr double kSumTolerance_mm = 5e-3;    // of a level that is the sum of several numbers
constexpr double kSameDirection = 1e-9;      // of unit vectors

Outcome rapid_to(Modal& m, const Vector3& tip, const Vector3& axis, std::uint32_t line) {
  if ((tip - m.path.tip()).norm() <= kMinMove_mm && axis == m.path.axis()) return {};
  return m.path.line_to(tip, axis, {BlockKind::kRapid, FeedMeaning::kNone, 0}, line);
}

double retract_level(const Modal& m, const Vector3& top, const Vector3& axis) {
  const HoleCycle& cycle = *m.cycle;
  const double to_mm = m.units.to_mm;
  const double rapid = cycle.rapid_level * to_mm;
  if (m.cycle_return == CycleReturn::kToRapidLevel) return rapid;
  if (cycle.returns == CycleReturn::kToBefore && m.before_cycle) {
    return std::max(cycle.retract_level * to_mm, axis.dot(*m.before_cycle - top));
  }
  return std::max(cycle.retract_level * to_mm, rapid);
}

/// A wrong reading of a cycle's levels shows at the first hole: CAM systems bring the tool to the
/// retract level over it before the cycle begins. HSM posts of two kinds write alike, and what is
/// the top of a hole for one is its bottom for the other.
Outcome check_first_level(Modal& m, const Vector3& top, double retract_mm, std::uint32_t line) {
  const bool is_hsm = m.dialect.dialect() == Dialect::kHsm;
  const bool is_shown = is_hsm || m.dialect.dialect() == Dialect::kSolidWorks;
  if (!is_shown || m.holes_of_cycle > 0) return {};
  const double level = m.axis.in_w.dot(m.path.tip() - top);
  const double tolerance_mm = is_hsm ? kSumTolerance_mm : kLevelTolerance_mm;
  if (std::abs(level - retract_mm) <= tolerance_mm) return {};
  const std::string text = "the tool stands " + short_number(level) +
                           " mm above the first hole, not at the " + short_number(retract_mm) +
                           " mm to which the cycle retracts";
  if (is_hsm && m.path.position() == BlockPath::Position::kReached) {
    return refuse(text + ", as this dialect has it",
                  "--dialect fusion where the points are the bottoms of the holes");
  }
  m.remarks.warn("first level", line, [&] { return text + ": are its levels right?"; });
  return {};
}

/// Autodesk's ISO 4343 post gives the bottom of every hole, and the clearance as a Z.
Outcome count_from_top(Modal& m, Vector3& point) {
  HoleCycle& cycle = *m.cycle;
  if (!cycle.clearance_z) return {};
  const Vector3& axis = m.axis.in_w;
  if ((axis - m.frames.direction(Vector3::UnitZ())).norm() > kSameDirection) {
    return refuse(
        "a hole along a tilted axis, whose clearance is a Z of a plane that the file lacks",
        "let the CAM system write the holes out as motion");
  }
  const double to_mm = m.units.to_mm;
  const Vector3 clearance = m.frames.point(Vector3(0, 0, *cycle.clearance_z * to_mm));
  point += cycle.depth * to_mm * axis;
  cycle.retract_level = axis.dot(clearance - point) / to_mm;
  cycle.rapid_level = cycle.retract_level - cycle.rapid_below;
  if (cycle.rapid_level * to_mm >= -kLevelTolerance_mm) return {};
  return refuse("CYCLE: the rapid level lies " + short_number(cycle.rapid_level) +
                " above the top of the hole: inside the part");
}

/// Over the hole, at the higher of the level where the tool is and the retract level.
Outcome go_over(Modal& m, const Vector3& top, double retract_mm, std::uint32_t line) {
  const Vector3& axis = m.axis.in_w;
  if (m.path.position() != BlockPath::Position::kReached) {
    return rapid_to(m, top + retract_mm * axis, axis, line);
  }
  if (axis != m.path.axis()) {
    m.remarks.warn("tilted holes", line, [] {
      return "the tool axis turns between holes of a cycle: the tool turns and travels in one "
             "rapid "
             "block from one retract level to the next; see that nothing is in the way";
    });
    return rapid_to(m, top + retract_mm * axis, axis, line);
  }
  const Vector3 tip = m.path.tip();
  const double level = axis.dot(tip - top);
  const double over = std::max(level, retract_mm);
  if (level < over) {
    if (auto done = rapid_to(m, tip + (over - level) * axis, axis, line); !done) return done;
  }
  return rapid_to(m, top + over * axis, axis, line);
}

double dwell_of(const Modal& m) {
  const HoleCycle& cycle = *m.cycle;
  if (!(cycle.dwell_revolutions > 0)) return cycle.dwell_s;
  return cycle.dwell_revolutions * units::kMinute_s / m.spindle.speed_rpm;
}

/// Down into the hole, and out where the cycle does not go out at rapid.
struct HoleFeeds {
  MotionFeed in, out;
};

Outcome run_move(Modal& m, const HoleMove& move, const Vector3& top, const HoleFeeds& feeds,
                 std::uint32_t line) {
  const Vector3& axis = m.axis.in_w;
  const Vector3 tip = top + move.level_mm * axis;
  switch (move.kind) {
    case HoleMove::Kind::kRapid:
      return rapid_to(m, tip, axis, line);
    case HoleMove::Kind::kFeed:
      return m.path.line_to(tip, axis, feeds.in, line);
    case HoleMove::Kind::kFeedOut:
      return m.path.line_to(tip, axis, feeds.out, line);
    case HoleMove::Kind::kDwell:
      m.summary.dwell_time_s += dwell_of(m);
      m.path.act(BlockKind::kDwell, ActionKind::kNone, dwell_of(m), line);
      return {};
    case HoleMove::Kind::kSpindleStop:
      m.path.act(BlockKind::kAuxiliary, ActionKind::kSpindleOff, 0, line);
      return {};
    case HoleMove::Kind::kSpindleStart:
      m.path.act(BlockKind::kAuxiliary, m.spindle.sense, m.spindle.speed_rpm, line);
      return {};
  }
  return {};
}

Expected<MotionFeed, Refusal> feed_of_cycle(Modal& m, const WrittenFeed& written,
                                            std::uint32_t line) {
  if (auto done = check_unit_by_feed(m, written.unit); !done) {
    return tl::make_unexpected(done.error());
  }
  auto feed = feed_of(written, {*m.units.in_force, m.spindle});
  if (!feed) return feed;
  remark_on_feed(written, *feed, *m.units.in_force, m.options.max_feed_mm_per_s, line, m.remarks);
  if (feed->meaning != FeedMeaning::kTip)
    return refuse("a cycle with a feed in inverse time", "give CYCLE a feed of its own (MMPM)");
  m.summary.feed_min_mm_per_s = std::min(m.summary.feed_min_mm_per_s, feed->feed);
  m.summary.feed_max_mm_per_s = std::max(m.summary.feed_max_mm_per_s, feed->feed);
  return feed;
}

Expected<HoleFeeds, Refusal> feeds_of_cycle(Modal& m, std::uint32_t line) {
  const HoleCycle& cycle = *m.cycle;
  const auto in = cycle.feed.unit == FeedUnit::kNone ? cutting_feed(m, line)
                                                     : feed_of_cycle(m, cycle.feed, line);
  if (!in) return tl::make_unexpected(in.error());
  if (cycle.feed_out.unit == FeedUnit::kNone) return HoleFeeds{*in, *in};
  const auto out = feed_of_cycle(m, cycle.feed_out, line);
  if (!out) return tl::make_unexpected(out.error());
  return HoleFeeds{*in, *out};
}

void end_cycle(Modal& m) {
  m.cycle.reset();
  m.before_cycle.reset();
  m.cycle_return = CycleReturn::kToRetract;
  m.is_cycle_of_path_before = false;
}

}  // namespace

Outcome read_cycle_word(Modal& m, const Statement& s) {
  see_unit_by_feed(m, s);
  auto written = read_cycle(s, m.dialect);
  if (!written) {
    m.cycle.emplace().kind = HoleKind::kRefused;
    m.last_cycle = m.cycle;
    if (written.error().group.empty())
      written.error().group = "CYCLE/" + std::string(s.rest.substr(0, 12));
    return tl::make_unexpected(written.error());
  }
  if (m.curve.index() != 0) return refuse("CYCLE inside an arc or a spline");
  switch (written->kind) {
    case CycleStatement::Kind::kOff:
      end_cycle(m);
      return {};
    case CycleStatement::Kind::kReturn:
      m.cycle_return = written->returns;
      return {};
    case CycleStatement::Kind::kOn:
      if (!m.last_cycle) return refuse("CYCLE/ON before any cycle");
      m.cycle = m.last_cycle;
      break;
    case CycleStatement::Kind::kDefine:
      m.cycle = m.last_cycle = written->cycle;
      break;
  }
  if (written->has_odd_sign) {
    m.remarks.warn("cycle sign", s.line, [&m] {
      return std::string("CYCLE: the depth is ") +
             (m.dialect.traits().depth_is_negative ? "not below zero" : "below zero") +
             ", which this dialect does not write: its magnitude counts, down from the point";
    });
  }
  m.is_cycle_of_path_before = false;
  m.next = NextMotion::kFeed;  // a cycle has its own rapids
  m.holes_of_cycle = 0;
  if (!m.before_cycle && m.path.position() == BlockPath::Position::kReached) {
    m.before_cycle = m.path.tip();
  }
  return {};
}

Outcome run_hole(Modal& m, const Vector3& point, std::uint32_t line) {
  if (m.cycle->kind == HoleKind::kRefused) {
    m.path.lose_position();
    return {};
  }
  if (m.is_cycle_of_path_before) {
    m.path.lose_position();
    return refuse("a point while the CYCLE of the tool path before is still on: a hole there?",
                  "write CYCLE/OFF ahead of END-OF-PATH, or CYCLE in this path too", "open cycle");
  }
  Vector3 top = point;
  if (auto done = count_from_top(m, top); !done) return done;
  const auto feeds = feeds_of_cycle(m, line);
  if (!feeds) return tl::make_unexpected(feeds.error());
  if (m.cycle->dwell_revolutions > 0 && !m.spindle.turns()) {
    return refuse("dwell in revolutions, but no spindle speed is in force",
                  "write SPINDL before it");
  }
  if (m.cycle->kind == HoleKind::kStopOut && !m.spindle.turns()) {
    return refuse("the cycle stops the spindle and starts it again, but it does not turn",
                  "write SPINDL before it");
  }
  const double retract_mm = retract_level(m, top, m.axis.in_w);
  if (auto done = check_first_level(m, top, retract_mm, line); !done) return done;
  if (auto done = go_over(m, top, retract_mm, line); !done) return done;
  for (const HoleMove& move : moves_of(*m.cycle, {retract_mm, m.units.to_mm})) {
    if (auto done = run_move(m, move, top, *feeds, line); !done) return done;
  }
  ++m.summary.holes;
  ++m.holes_of_cycle;
  if (m.cycle->ends_after_one) end_cycle(m);
  return {};
}

}  // namespace meridian::cl
