// SPDX-License-Identifier: Apache-2.0
#include "service/cl/cl_summary.hpp"

#include "meridian/units.hpp"
#include "service/text/printed.hpp"

namespace meridian::cl {

using text::append;
using text::Count;

std::string to_text(const ClSummary& s) {
  std::string text;
  const auto count = [&s](BlockKind kind) {
    return Count{s.blocks_by_kind[static_cast<std::size_t>(kind)]};
  };
  append(text, "dialect        %s\n", s.dialect.c_str());
  if (!s.program.empty()) append(text, "program        %s\n", s.program.c_str());
  append(text, "unit           %s\n", s.unit == LengthUnit::kInch ? "inch" : "millimetre");
  append(text, "lines          %llu (%llu bytes, %llu comments)\n", Count{s.lines}, Count{s.bytes},
         Count{s.comments});
  append(text,
         "blocks         %llu: cut %llu, rapid %llu, dwell %llu, auxiliary %llu, tool %llu, stop "
         "%llu\n",
         Count{s.blocks}, count(BlockKind::kCut), count(BlockKind::kRapid),
         count(BlockKind::kDwell), count(BlockKind::kAuxiliary), count(BlockKind::kTool),
         count(BlockKind::kStop) + count(BlockKind::kOptionalStop));
  append(text, "GOTO           %llu with 3 numbers, %llu with 6; %llu of zero length\n",
         Count{s.goto_three}, Count{s.goto_six}, Count{s.zero_length});
  append(text, "arcs           %llu (%llu full circles, radius mismatch up to %.3g um)\n",
         Count{s.arcs}, Count{s.full_circles}, s.arc_mismatch_max_mm * 1e3);
  if (s.box_min_mm[0] <= s.box_max_mm[0]) {
    for (std::size_t i = 0; i < 3; ++i) {
      append(text, "%c              %.6f .. %.6f mm\n", "xyz"[i], s.box_min_mm[i], s.box_max_mm[i]);
    }
    append(text, "tool axis      %.3f .. %.3f deg from z, up to %.3f deg in one block\n",
           units::deg_from_rad(s.tilt_min_rad), units::deg_from_rad(s.tilt_max_rad),
           units::deg_from_rad(s.axis_change_max_rad));
  }
  if (s.feed_min_mm_per_s <= s.feed_max_mm_per_s) {
    append(text, "feed           %.6g .. %.6g mm/min\n",
           units::per_min_from_per_s(s.feed_min_mm_per_s),
           units::per_min_from_per_s(s.feed_max_mm_per_s));
  }
  append(text, "path           %.3f mm cut, %.3f mm rapid; %.3f s at the programmed feed\n",
         s.cut_length_mm, s.rapid_length_mm, s.cut_time_s + s.dwell_time_s);
  if (!s.tools.empty()) {
    append(text, "tools         ");
    for (const std::uint32_t tool : s.tools) append(text, " %u", tool);
    append(text, "\n");
  }
  if (s.frame_changes > 0) append(text, "frame changes  %llu\n", Count{s.frame_changes});
  return text;
}

}  // namespace meridian::cl
