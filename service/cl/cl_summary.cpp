// SPDX-License-Identifier: Apache-2.0
#include "service/cl/cl_summary.hpp"

#include <cstdarg>
#include <cstdio>

#include "meridian/units.hpp"

namespace meridian::cl {
namespace {

[[gnu::format(printf, 2, 3)]] void add(std::string& text, const char* format, ...) {
  std::array<char, 256> line{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line.data(), line.size(), format, arguments);
  va_end(arguments);
  text += line.data();
}

}  // namespace

std::string to_text(const ClSummary& s) {
  std::string text;
  const auto count = [&s](BlockKind kind) {
    return static_cast<unsigned long>(s.blocks_by_kind[static_cast<std::size_t>(kind)]);
  };
  const auto number = [](std::uint64_t n) { return static_cast<unsigned long>(n); };
  add(text, "dialect        %s\n", s.dialect.c_str());
  if (!s.program.empty()) add(text, "program        %s\n", s.program.c_str());
  add(text, "unit           %s\n", s.unit == LengthUnit::kInch ? "inch" : "millimetre");
  add(text, "lines          %lu (%lu bytes, %lu comments)\n", number(s.lines), number(s.bytes),
      number(s.comments));
  add(text,
      "blocks         %lu: cut %lu, rapid %lu, dwell %lu, auxiliary %lu, tool %lu, stop %lu\n",
      number(s.blocks), count(BlockKind::kCut), count(BlockKind::kRapid), count(BlockKind::kDwell),
      count(BlockKind::kAuxiliary), count(BlockKind::kTool),
      count(BlockKind::kStop) + count(BlockKind::kOptionalStop));
  add(text, "GOTO           %lu with 3 numbers, %lu with 6; %lu of zero length\n",
      number(s.goto_three), number(s.goto_six), number(s.zero_length));
  add(text, "arcs           %lu (%lu full circles, radius mismatch up to %.3g um)\n",
      number(s.arcs), number(s.full_circles), s.arc_mismatch_max_mm * 1e3);
  if (s.box_min_mm[0] <= s.box_max_mm[0]) {
    for (std::size_t i = 0; i < 3; ++i) {
      add(text, "%c              %.6f .. %.6f mm\n", "xyz"[i], s.box_min_mm[i], s.box_max_mm[i]);
    }
    add(text, "tool axis      %.3f .. %.3f deg from z, up to %.3f deg in one block\n",
        units::deg_from_rad(s.tilt_min_rad), units::deg_from_rad(s.tilt_max_rad),
        units::deg_from_rad(s.axis_change_max_rad));
  }
  if (s.feed_min_mm_per_s <= s.feed_max_mm_per_s) {
    add(text, "feed           %.6g .. %.6g mm/min\n",
        units::per_min_from_per_s(s.feed_min_mm_per_s),
        units::per_min_from_per_s(s.feed_max_mm_per_s));
  }
  add(text, "path           %.3f mm cut, %.3f mm rapid; %.3f s at the programmed feed\n",
      s.cut_length_mm, s.rapid_length_mm, s.cut_time_s + s.dwell_time_s);
  if (!s.tools.empty()) {
    add(text, "tools         ");
    for (const std::uint32_t tool : s.tools) add(text, " %u", tool);
    add(text, "\n");
  }
  if (s.frame_changes > 0) add(text, "frame changes  %lu\n", number(s.frame_changes));
  return text;
}

}  // namespace meridian::cl
