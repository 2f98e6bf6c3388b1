// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/cl_summary.hpp"

#include "meridian/units.hpp"
#include "service/text/printed.hpp"

namespace meridian::cl {

using text::append;
using text::Count;

namespace {

std::string unit_text(const ClSummary& s) {
  const std::string unit = name_of(s.unit);
  switch (s.unit_source) {
    case UnitSource::kFile:
      return unit;
    case UnitSource::kCaller:
      return unit + " (--units)";
    case UnitSource::kFeed:
      return unit + " (NO UNIT WORD IN THE FILE: as its feeds are)";
    case UnitSource::kStation:
      return unit + " (NO UNIT WORD IN THE FILE: the station's default)";
  }
  return unit;
}

const char* source_name(UnitSource source) {
  switch (source) {
    case UnitSource::kFile:
      return "file";
    case UnitSource::kCaller:
      return "option";
    case UnitSource::kFeed:
      return "feed";
    case UnitSource::kStation:
      break;
  }
  return "default";
}

Count blocks_of(const ClSummary& s, BlockKind kind) {
  return s.blocks_by_kind[static_cast<std::size_t>(kind)];
}

void append_path(std::string& text, const ClSummary& s) {
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
}

void append_points(std::string& text, const ClSummary& s) {
  if (!s.nc.is_nc) {
    append(text, "GOTO           %llu with 3 numbers, %llu with 6; %llu of zero length\n",
           Count{s.goto_three}, Count{s.goto_six}, Count{s.zero_length});
    return;
  }
  append(text, "points         %llu with tool-centre control, %llu without; %llu of zero length\n",
         Count{s.goto_six}, Count{s.goto_three}, Count{s.zero_length});
  append(text, "work offset    %s: where the part lies, as %s\n",
         s.nc.work_offset.empty() ? "none" : s.nc.work_offset.c_str(),
         s.nc.has_work_zero ? "the machine's work frames or --work-zero say"
                            : "the machine file or --frame says");
  if (s.nc.axis_tolerance_rad > 0) {
    append(text,
           "rotary words   %llu blocks cut into %llu, so that the tool axis stays within %.3g deg "
           "of joints that turn evenly\n",
           Count{s.nc.turned_blocks}, Count{s.nc.turned_pieces},
           units::deg_from_rad(s.nc.axis_tolerance_rad));
  }
}

std::string array_json(const Array3& a) {
  std::string out = "[";
  for (std::size_t i = 0; i < 3; ++i) {
    out += (i > 0 ? ", " : "") + text::json_number("%.9g", a[i]);
  }
  return out + "]";
}

}  // namespace

std::string skipped_text(const ClSummary& s) {
  std::string text;
  for (const SkippedWord& word : s.skipped) {
    append(text, "%s%s (%llu)", text.empty() ? "" : ", ", word.word.c_str(), Count{word.count});
  }
  return text;
}

std::string to_text(const ClSummary& s) {
  std::string text;
  append(text, "dialect        %s (%s)\n", s.dialect.c_str(),
         s.dialect_reason.empty() ? "nothing shows what wrote it" : s.dialect_reason.c_str());
  if (!s.program.empty()) append(text, "program        %s\n", s.program.c_str());
  append(text, "unit           %s\n", unit_text(s).c_str());
  append(text, "lines          %llu (%llu bytes, %llu comments)\n", Count{s.lines}, Count{s.bytes},
         Count{s.comments});
  append(text,
         "blocks         %llu: cut %llu, rapid %llu, dwell %llu, auxiliary %llu, tool %llu, stop "
         "%llu\n",
         Count{s.blocks}, blocks_of(s, BlockKind::kCut), blocks_of(s, BlockKind::kRapid),
         blocks_of(s, BlockKind::kDwell), blocks_of(s, BlockKind::kAuxiliary),
         blocks_of(s, BlockKind::kTool),
         blocks_of(s, BlockKind::kStop) + blocks_of(s, BlockKind::kOptionalStop));
  append_points(text, s);
  if (s.listed_points > 0) append(text, "point lists    %llu points\n", Count{s.listed_points});
  append(text, "arcs           %llu (%llu full circles, radius mismatch up to %.3g um)\n",
         Count{s.arcs}, Count{s.full_circles}, s.arc_mismatch_max_mm * 1e3);
  if (s.splines > 0) append(text, "splines        %llu\n", Count{s.splines});
  if (s.holes > 0) append(text, "holes          %llu by canned cycles\n", Count{s.holes});
  append_path(text, s);
  if (!s.tools.empty()) {
    append(text, "tools         ");
    for (const std::uint32_t tool : s.tools) append(text, " %u", tool);
    append(text, "\n");
  }
  if (s.frame_changes > 0) append(text, "frame changes  %llu\n", Count{s.frame_changes});
  if (!s.skipped.empty()) append(text, "skipped        %s\n", skipped_text(s).c_str());
  return text;
}

std::string to_json(const ClSummary& s) {
  std::string text = "{\n";
  append(text, "  \"dialect\": %s,\n  \"dialect_reason\": %s,\n  \"program\": %s,\n",
         text::json_quoted(s.dialect).c_str(), text::json_quoted(s.dialect_reason).c_str(),
         text::json_quoted(s.program).c_str());
  append(text, "  \"unit\": \"%s\",\n  \"unit_source\": \"%s\",\n",
         s.unit == LengthUnit::kInch ? "inch" : "mm", source_name(s.unit_source));
  append(text, "  \"lines\": %llu,\n  \"bytes\": %llu,\n  \"comments\": %llu,\n", Count{s.lines},
         Count{s.bytes}, Count{s.comments});
  append(text,
         "  \"blocks\": %llu,\n  \"cut\": %llu,\n  \"rapid\": %llu,\n  \"dwell\": %llu,\n"
         "  \"auxiliary\": %llu,\n  \"tool_changes\": %llu,\n",
         Count{s.blocks}, blocks_of(s, BlockKind::kCut), blocks_of(s, BlockKind::kRapid),
         blocks_of(s, BlockKind::kDwell), blocks_of(s, BlockKind::kAuxiliary),
         blocks_of(s, BlockKind::kTool));
  append(text,
         "  \"goto_three\": %llu,\n  \"goto_six\": %llu,\n  \"listed_points\": %llu,\n"
         "  \"zero_length\": %llu,\n  \"arcs\": %llu,\n  \"full_circles\": %llu,\n"
         "  \"splines\": %llu,\n  \"holes\": %llu,\n  \"frame_changes\": %llu,\n",
         Count{s.goto_three}, Count{s.goto_six}, Count{s.listed_points}, Count{s.zero_length},
         Count{s.arcs}, Count{s.full_circles}, Count{s.splines}, Count{s.holes},
         Count{s.frame_changes});
  append(text, "  \"box_min_mm\": %s,\n  \"box_max_mm\": %s,\n", array_json(s.box_min_mm).c_str(),
         array_json(s.box_max_mm).c_str());
  append(text, "  \"tilt_min_deg\": %s,\n  \"tilt_max_deg\": %s,\n",
         text::json_number("%.9g", units::deg_from_rad(s.tilt_min_rad)).c_str(),
         text::json_number("%.9g", units::deg_from_rad(s.tilt_max_rad)).c_str());
  append(text, "  \"feed_min_mm_per_min\": %s,\n  \"feed_max_mm_per_min\": %s,\n",
         text::json_number("%.9g", units::per_min_from_per_s(s.feed_min_mm_per_s)).c_str(),
         text::json_number("%.9g", units::per_min_from_per_s(s.feed_max_mm_per_s)).c_str());
  append(text, "  \"cut_mm\": %s,\n  \"rapid_mm\": %s,\n  \"time_s\": %s,\n",
         text::json_number("%.9g", s.cut_length_mm).c_str(),
         text::json_number("%.9g", s.rapid_length_mm).c_str(),
         text::json_number("%.9g", s.cut_time_s + s.dwell_time_s).c_str());
  append(text, "  \"resolution_mm\": %s,\n  \"tools\": [",
         text::json_number("%.3g", s.resolution_mm()).c_str());
  for (std::size_t i = 0; i < s.tools.size(); ++i) {
    append(text, "%s%u", i > 0 ? ", " : "", s.tools[i]);
  }
  text += "],\n";
  if (s.nc.is_nc) {
    append(text, "  \"work_offset\": %s,\n  \"turned_blocks\": %llu,\n  \"turned_pieces\": %llu,\n",
           text::json_quoted(s.nc.work_offset).c_str(), Count{s.nc.turned_blocks},
           Count{s.nc.turned_pieces});
  }
  text += "  \"skipped\": {";
  for (std::size_t i = 0; i < s.skipped.size(); ++i) {
    append(text, "%s%s: %llu", i > 0 ? ", " : "", text::json_quoted(s.skipped[i].word).c_str(),
           Count{s.skipped[i].count});
  }
  return text + "}\n}";
}

}  // namespace meridian::cl
