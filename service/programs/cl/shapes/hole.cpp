// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/shapes/hole.hpp"

#include <algorithm>

namespace meridian::cl {
namespace {

using Kind = HoleMove::Kind;

/// Levels at which the pecks end, from the top down; the last is the bottom.
std::vector<double> ends_of_pecks(const HoleCycle& cycle, double to_mm) {
  const double bottom = cycle.depth * to_mm;
  std::vector<double> ends;
  double depth = 0;
  for (std::size_t i = 0; !cycle.pecks.empty(); ++i) {
    depth += cycle.pecks[std::min(i, cycle.pecks.size() - 1)] * to_mm;
    if (depth >= bottom) break;
    ends.push_back(-depth);
  }
  ends.push_back(-bottom);
  return ends;
}

/// How far the tool stays away from where it was, or goes back: never more than half of the peck.
double gap_of(double wanted_mm, double from_mm, double to_mm) {
  return std::min(wanted_mm, (from_mm - to_mm) / 2);
}

}  // namespace

std::vector<HoleMove> moves_of(const HoleCycle& cycle, const HoleLevels& levels) {
  const double rapid = cycle.rapid_level * levels.to_mm;
  const bool dwells = cycle.dwell_s > 0 || cycle.dwell_revolutions > 0;
  const bool feeds_out = cycle.kind == HoleKind::kFeedOut || cycle.feed_out.unit != FeedUnit::kNone;
  const Kind out = feeds_out ? Kind::kFeedOut : Kind::kRapid;
  std::vector<HoleMove> moves{{Kind::kRapid, rapid}};
  double from = 0;
  int broken = 0;
  const std::vector<double> ends = ends_of_pecks(cycle, levels.to_mm);
  for (const double end : ends) {
    moves.push_back({Kind::kFeed, end});
    const bool is_bottom = end == ends.back();
    if (dwells && (is_bottom || cycle.dwells_at_pecks)) moves.push_back({Kind::kDwell, end});
    if (is_bottom) break;
    const bool is_out = cycle.kind == HoleKind::kDeep ||
                        (cycle.pecks_to_retract > 0 && ++broken % cycle.pecks_to_retract == 0);
    if (is_out) {
      moves.push_back({out, rapid});
      moves.push_back({Kind::kRapid, end + gap_of(kPeckGap_mm, from, end)});
    } else {
      const double back = cycle.back > 0 ? cycle.back * levels.to_mm : kChipBack_mm;
      moves.push_back({Kind::kRapid, end + gap_of(back, from, end)});
    }
    from = end;
  }
  if (cycle.ends_after_one) return moves;
  if (feeds_out) moves.push_back({Kind::kFeedOut, rapid});
  if (cycle.kind == HoleKind::kStopOut) moves.push_back({Kind::kSpindleStop, ends.back()});
  const double retract = std::max(levels.retract_mm, rapid);
  moves.push_back({Kind::kRapid, retract});
  if (cycle.kind == HoleKind::kStopOut) moves.push_back({Kind::kSpindleStart, retract});
  return moves;
}

}  // namespace meridian::cl
