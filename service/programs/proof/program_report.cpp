// SPDX-License-Identifier: Apache-2.0
#include "meridian/units.hpp"
#include "service/programs/proof/program_check.hpp"
#include "service/text/printed.hpp"

namespace meridian::proof {

using text::append;
using text::Count;
using text::json_quoted;

namespace {

void append_peak(std::string& text, const char* name, const ProgramPeak& peak, double scale,
                 double tolerance, const char* unit) {
  append(text, "%-10s %.6f %s at most (line %u of the program); tolerance %.6g %s\n", name,
         peak.value * scale, unit, peak.line, tolerance * scale, unit);
}

void append_json_peak(std::string& text, const char* name, const ProgramPeak& peak, double scale) {
  append(text, "  \"%s\": {\"value\": %.9g, \"line\": %u},\n", name, peak.value * scale, peak.line);
}

}  // namespace

std::string to_text(const ProgramReport& report) {
  const double deg = units::deg_from_rad(1);
  std::string text;
  append(text, "program    %s against %s\n", report.program.c_str(), report.path_name.c_str());
  append(text, "path       %llu CL motions, %.3f mm of tip, %llu moves of the program on it\n",
         static_cast<Count>(report.motions), report.tip_length_mm,
         static_cast<Count>(report.moves));
  if (report.rewinds > 0) {
    append(text, "rewound    %llu times, off the part\n", static_cast<Count>(report.rewinds));
  }
  append_peak(text, "tip", report.tip_mm, 1, report.tip_tolerance_mm, "mm");
  append_peak(text, "tool axis", report.axis_rad, deg, report.axis_tolerance_rad, "deg");
  for (const ProgramFinding& finding : report.findings) {
    append(text, "FAIL       %s", finding.text.c_str());
    if (finding.line > 0) append(text, ", line %u of the program", finding.line);
    if (finding.cl_line > 0) append(text, ", CL line %u", finding.cl_line);
    text += "\n";
  }
  text += report.passed() ? "PASS\n" : "FAIL\n";
  return text;
}

std::string to_json(const ProgramReport& report) {
  const double deg = units::deg_from_rad(1);
  std::string text = "{\n";
  append(text, "  \"passed\": %s,\n", report.passed() ? "true" : "false");
  append(text, "  \"program\": %s,\n", json_quoted(report.program).c_str());
  append(text, "  \"path\": %s,\n", json_quoted(report.path_name).c_str());
  append(text, "  \"cl_motions\": %llu,\n", static_cast<Count>(report.motions));
  append(text, "  \"moves\": %llu,\n", static_cast<Count>(report.moves));
  append(text, "  \"rewinds\": %llu,\n", static_cast<Count>(report.rewinds));
  append(text, "  \"tip_length_mm\": %.9g,\n", report.tip_length_mm);
  append(text, "  \"tip_tolerance_mm\": %.9g,\n", report.tip_tolerance_mm);
  append(text, "  \"axis_tolerance_deg\": %.9g,\n", report.axis_tolerance_rad * deg);
  append_json_peak(text, "tip_mm", report.tip_mm, 1);
  append_json_peak(text, "axis_deg", report.axis_rad, deg);
  text += "  \"findings\": [";
  const char* separator = "\n";
  for (const ProgramFinding& finding : report.findings) {
    append(text, "%s    {\"text\": %s, \"line\": %u, \"cl_line\": %u}", separator,
           json_quoted(finding.text).c_str(), finding.line, finding.cl_line);
    separator = ",\n";
  }
  text += report.findings.empty() ? "]\n}\n" : "\n  ]\n}\n";
  return text;
}

}  // namespace meridian::proof
