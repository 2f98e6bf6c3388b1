// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/words/motion.hpp"

#include <algorithm>

#include "meridian/units.hpp"
#include "service/programs/cl/text/written_text.hpp"

namespace meridian::cl {
namespace {

constexpr double kFarthest_mm = 1e6;  // no machine is larger; catches lost decimal points
constexpr double kLargestCutter_mm = 120;

std::string option_for(LengthUnit unit) {
  return unit == LengthUnit::kInch ? "--units inch" : "--units mm";
}

LengthUnit other_than(LengthUnit unit) {
  return unit == LengthUnit::kInch ? LengthUnit::kMillimetre : LengthUnit::kInch;
}

/// What the feed words of a file without a unit word show, else the default; it is said.
LengthUnit unit_without_word(Modal& m, std::uint32_t line) {
  Units& units = m.units;
  const auto& given = m.options.default_unit;
  if (!units.by_feed && m.look_ahead) units.by_feed = m.look_ahead();
  m.summary.unit_source = units.by_feed ? UnitSource::kFeed : UnitSource::kStation;
  const LengthUnit unit =
      units.by_feed ? units.by_feed->unit : given.value_or(LengthUnit::kMillimetre);
  m.remarks.warn("unit default", line, [&] {
    const std::string why =
        units.by_feed ? "as its feeds are (line " + std::to_string(units.by_feed->line) + ")"
                      : std::string("the ") + (given ? "machine's" : "station's") + " default";
    return std::string("NO UNIT WORD IN THE FILE: read in ") + name_of(unit) + ", " + why + "; " +
           option_for(other_than(unit)) + " if that is wrong";
  });
  return unit;
}

/// What the caller says, the file's unit word, or what holds without one.
void resolve_unit(Modal& m, std::uint32_t line) {
  LengthUnit unit = LengthUnit::kMillimetre;
  if (m.options.unit) {
    unit = *m.options.unit;
    m.summary.unit_source = UnitSource::kCaller;
  } else if (m.units.stated) {
    unit = *m.units.stated;
    m.summary.unit_source = UnitSource::kFile;
  } else {
    unit = unit_without_word(m, line);
  }
  m.units.in_force = unit;
  m.units.to_mm = unit == LengthUnit::kInch ? units::kInch_mm : 1.0;
  m.summary.unit = unit;
  m.feed.reset();
  const double cutter_mm = m.units.cutter * m.units.to_mm;
  if (unit == LengthUnit::kInch && cutter_mm > kLargestCutter_mm) {
    m.summary.is_suspected_metric = true;
    m.remarks.warn("metric", line, [&m] {
      return "inch, but the cutter is " + short_number(m.units.cutter) +
             " wide: plainly metric? (--units mm)";
    });
  }
}

}  // namespace

Outcome begin_motion(Modal& m, std::uint32_t line) {
  if (m.units.in_force && m.frames.is_resolved()) [[likely]]
    return {};
  if (!m.units.in_force) resolve_unit(m, line);
  if (m.frames.resolve(m.units.to_mm)) {
    ++m.summary.frame_changes;
    m.remarks.warn("frame", line, [] {
      return "the file changes its frame after motion has begun: all poses are given in the first "
             "one";
    });
  }
  m.axis.in_w = m.frames.direction(to_vector(m.axis.written).normalized());
  return {};
}

Expected<Vector3, Refusal> point_in_w(const Modal& m, const double* xyz) {
  const double to_mm = m.units.to_mm;
  const Vector3 p{xyz[0] * to_mm, xyz[1] * to_mm, xyz[2] * to_mm};
  const Vector3 in_w = m.frames.point(p);
  const double farthest = std::max(p.cwiseAbs().maxCoeff(), in_w.cwiseAbs().maxCoeff());
  if (!(p.allFinite() && in_w.allFinite() && farthest <= kFarthest_mm)) {
    return refuse("a coordinate lies beyond 1e6 mm");
  }
  return in_w;
}

Outcome set_axis(Modal& m, const double* ijk, ToolAxis::Source source) {
  ToolAxis& axis = m.axis;
  axis.source = source;
  // A file whose axis does not change is the rule: the modal vector then needs no square root.
  if (ijk[0] == axis.written[0] && ijk[1] == axis.written[1] && ijk[2] == axis.written[2]) {
    return {};
  }
  const Vector3 k{ijk[0], ijk[1], ijk[2]};
  const double norm = k.norm();
  if (!(std::abs(norm - 1) <= kAxisNormTolerance)) {
    return refuse("tool axis (" + short_number(k[0]) + ", " + short_number(k[1]) + ", " +
                  short_number(k[2]) + ") is not a unit vector: its length is " +
                  short_number(norm) + ", allowed 1 +- 0.001");
  }
  axis.written = {ijk[0], ijk[1], ijk[2]};
  axis.in_w = m.frames.direction(k / norm);
  return {};
}

Outcome axis_left_out(Modal& m, std::uint32_t line) {
  constexpr std::array<double, 3> kPlusZ{0, 0, 1};
  const MissingAxis meaning = m.dialect.missing_axis();
  if (meaning == MissingAxis::kCsys && m.frames.csys_axis()) {
    const std::array<double, 3> z = to_array(*m.frames.csys_axis());
    return set_axis(m, z.data(), ToolAxis::Source::kNone);
  }
  if (m.axis.source == ToolAxis::Source::kCopied) {
    return refuse("a point without a tool axis where COPY has changed the axis",
                  "output the tool axis with every GOTO (MULTAX)");
  }
  if (m.axis.source != ToolAxis::Source::kPoint || meaning == MissingAxis::kStays) return {};
  if (m.axis.written == kPlusZ) return {};
  if (meaning == MissingAxis::kPlusZ) {
    m.remarks.warn("plus z", line, [] {
      return "points without a tool axis after a tilted one: the axis is +z there, as Creo means "
             "it";
    });
    return set_axis(m, kPlusZ.data(), ToolAxis::Source::kPoint);
  }
  return refuse(
      "a point without a tool axis after a tilted one: whether the axis stays, is +z, or that of "
      "the last CSYS is the CAM system's to say, and the file does not show which wrote it",
      "--dialect nx, catia, mastercam, hypermill, fusion or iso: it stays; creo: +z; solidworks: "
      "that of "
      "the last CSYS",
      "axis left out");
}

/// The feed words are all that shows the unit of a file without a unit word.
Outcome check_unit_by_feed(const Modal& m, FeedUnit feed) {
  const LengthUnit unit = *m.units.in_force, other = other_than(unit);
  const bool is_by_feed = m.summary.unit_source == UnitSource::kFeed;
  const bool has_no_word = is_by_feed || m.summary.unit_source == UnitSource::kStation;
  if (!has_no_word || !is_of_other_unit(feed, unit)) return {};
  const std::string remedy =
      option_for(other) + ", or " + option_for(unit) + " where the points are in " + name_of(unit);
  return refuse(
      std::string("a file without a unit word is read in ") + name_of(unit) +
          (is_by_feed ? ", as its feed in line " + std::to_string(m.units.by_feed->line) + " is"
                      : std::string()) +
          ", but this feed is in " + name_of(other),
      is_by_feed ? remedy : remedy + "; a file, unlike a pipe, is searched for its feeds first",
      "unit by feed");
}

Expected<MotionFeed, Refusal> cutting_feed(Modal& m, std::uint32_t line) {
  if (m.feed) [[likely]]
    return *m.feed;
  MotionFeed feed;
  if (m.written_feed.unit == FeedUnit::kNone) {
    if (!m.options.default_feed_mm_per_s) {
      return refuse("cutting motion, but no FEDRAT before it", "--feed MM_PER_MIN", "no feed");
    }
    feed = {BlockKind::kCut, FeedMeaning::kTip, *m.options.default_feed_mm_per_s};
  } else {
    if (auto done = check_unit_by_feed(m, m.written_feed.unit); !done) {
      return tl::make_unexpected(done.error());
    }
    const auto written = feed_of(m.written_feed, {*m.units.in_force, m.spindle});
    if (!written) return tl::make_unexpected(written.error());
    feed = *written;
    remark_on_feed(m.written_feed, feed, *m.units.in_force, m.options.max_feed_mm_per_s, line,
                   m.remarks);
  }
  if (feed.meaning == FeedMeaning::kTip) {
    m.summary.feed_min_mm_per_s = std::min(m.summary.feed_min_mm_per_s, feed.feed);
    m.summary.feed_max_mm_per_s = std::max(m.summary.feed_max_mm_per_s, feed.feed);
  }
  m.feed = feed;
  return feed;
}

Expected<MotionFeed, Refusal> next_feed(Modal& m, std::uint32_t line) {
  if (m.next == NextMotion::kFeed) [[likely]]
    return cutting_feed(m, line);
  m.next = NextMotion::kFeed;
  return MotionFeed{BlockKind::kRapid, FeedMeaning::kNone, 0};
}

}  // namespace meridian::cl
