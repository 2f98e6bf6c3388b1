// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/cl_options.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "meridian/units.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/file/range.hpp"
#include "service/programs/nc/nc_reader.hpp"
#include "service/text/number.hpp"
#include "service/text/printable.hpp"
#include "service/text/printed.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::cli {

void add_cl_file(CLI::App& command, std::string& name) {
  command
      .add_option("file", name,
                  "CL file (APT or CLDATA text) or NC program with tool-centre control; - is "
                  "standard input")
      ->required();
}

std::istream* open_cl_file(const std::string& name, std::ifstream& file) {
  if (name == "-") return &std::cin;
  file.open(name, std::ios::binary);
  return file ? &file : nullptr;
}

void print_warnings(const std::string& name, const std::vector<cl::ClWarning>& warnings) {
  for (const cl::ClWarning& warning : warnings) {
    std::cerr << text::printable(name) << ":" << warning.line
              << ": warning: " << text::printable(warning.message);
    if (warning.count > 1) std::cerr << " (" << warning.count << " places, first here)";
    std::cerr << "\n";
  }
}

namespace {

std::vector<std::string> dialect_names() {
  std::vector<std::string> names;
  for (const cl::DialectTraits& row : cl::dialects()) {
    if (!row.name.empty()) names.emplace_back(row.name);
  }
  return names;
}

}  // namespace

void add_cl_file_options(CLI::App& command, ClFileOptions& options, const char* dialect_name) {
  command
      .add_option(dialect_name, options.dialect,
                  "CAM system that wrote the file, where the file does not show it; fanuc, "
                  "siemens, heidenhain: an NC "
                  "program of their words")
      ->check(CLI::IsMember(dialect_names()));
  command
      .add_option("--units", options.units, "Unit of the file: mm or inch; wins over its unit word")
      ->check(CLI::IsMember({"mm", "inch"}));
  command
      .add_option("--feed", options.feed_mm_per_min,
                  "Feed before the first FEDRAT, mm/min, for files that have none")
      ->check(finite_range(1e-6, 1e6));
  command
      .add_option("--allow-unknown", options.allow_unknown,
                  "Pass this unknown word to the machine as a vendor word; may be repeated")
      ->type_name("WORD")
      ->allow_extra_args(false);
  command.add_flag("--allow-no-end", options.allow_no_end,
                   "Take a file without FINI, END or END-OF-PATH as whole");
  command
      .add_option("--arc-sense", options.arc_sense,
                  "Which way CIRCLE turns about its vector: form (by the number of its arguments), "
                  "right, left")
      ->check(CLI::IsMember({"form", "right", "left"}))
      ->capture_default_str();
  command
      .add_option("--work-zero", options.work_zeros,
                  "Where a work offset of an NC program lies, N=X,Y,Z in mm, in the frame of the "
                  "kinematics: 1 is G54, 2 G55, 7 G54.1 P1; may be repeated")
      ->type_name("N=X,Y,Z")
      ->allow_extra_args(false);
  command
      .add_option("--from-line", options.first_line,
                  "Begin with the first block from this line on; tool, spindle and coolant are set "
                  "and the place before it is approached first")
      ->check(finite_positive());
}

void add_join_options(CLI::App& command, JoinOptions& options) {
  command
      .add_option("--transition", options.transition,
                  "Instead of the machine file's: smooth (on through blocks) or exact_stop")
      ->check(CLI::IsMember({"smooth", "exact_stop"}));
  command
      .add_option("--tip-tolerance-mm", options.tip_tolerance_mm,
                  "Of smoothing, instead of the machine file's")
      ->check(finite_range(config::kTipTolerance_mm.low, config::kTipTolerance_mm.high));
  command
      .add_option("--axis-tolerance-deg", options.axis_tolerance_deg,
                  "Of smoothing, instead of the machine file's")
      ->check(finite_range(config::kAxisTolerance_deg.low, config::kAxisTolerance_deg.high));
}

SmoothSettings settings_of(const JoinOptions& join) {
  SmoothSettings settings;
  if (join.transition == "smooth") settings.transition = Transition::kSmooth;
  if (join.transition == "exact_stop") settings.transition = Transition::kExactStop;
  settings.tip_tolerance_mm = join.tip_tolerance_mm;
  settings.axis_tolerance_rad = units::rad_from_deg(join.axis_tolerance_deg);
  return settings;
}

std::string options_text(const ClFileOptions& file, const JoinOptions& join) {
  std::string text;
  const auto add = [&text](const char* name, const std::string& value) {
    if (!value.empty()) text::append(text, "%s%s %s", text.empty() ? "" : " ", name, value.c_str());
  };
  const auto number = [](double value) {
    std::string digits;
    if (value > 0) text::append(digits, "%.9g", value);
    return digits;
  };
  add("--dialect", file.dialect);
  add("--units", file.units);
  add("--feed", number(file.feed_mm_per_min.value_or(0)));
  for (const std::string& word : file.allow_unknown) add("--allow-unknown", word);
  for (const std::string& zero : file.work_zeros) add("--work-zero", zero);
  if (file.allow_no_end) text += text.empty() ? "--allow-no-end" : " --allow-no-end";
  add("--arc-sense", file.arc_sense == "form" ? "" : file.arc_sense);
  add("--transition", join.transition);
  add("--tip-tolerance-mm", number(join.tip_tolerance_mm));
  add("--axis-tolerance-deg", number(join.axis_tolerance_deg));
  return text.size() <= dds::kMaxOptions ? text : "(more than a session takes)";
}

void add_frame_option(CLI::App& command, ClFileOptions& options) {
  command.add_option("--frame", options.frame,
                     "Workpiece frame x,y,z[,a,b,c] in mm and deg (Rz(c) Ry(b) Rx(a)): poses are "
                     "put out in the frame around it");
}

namespace {

/// "2=100,0,0": where the zero of G55 lies.
std::pair<const int, Vector3> parse_work_zero(const std::string& option) {
  const auto refuse = [&option] {
    throw config::ConfigError({.key = "--work-zero",
                               .value = option,
                               .allowed = "N=X,Y,Z: a number from 1 to 999, mm within 1e5",
                               .remedy = "1 is G54, 2 G55, 7 G54.1 P1: --work-zero 2=100,0,0"});
  };
  constexpr double kMax_mm = 1e5;
  int number = 0;
  Vector3 zero;
  std::string_view rest = option;
  const std::size_t equals = std::min(rest.find('='), rest.size());
  if (!text::read_number(rest.substr(0, equals), number) || number < 1 || number > 999) refuse();
  rest.remove_prefix(std::min(equals + 1, rest.size()));
  for (int k = 0; k < 3; ++k) {
    const std::size_t comma = k < 2 ? std::min(rest.find(','), rest.size()) : rest.size();
    const bool is_number = text::read_finite(rest.substr(0, comma), zero[k]);
    if (!is_number || std::abs(zero[k]) > kMax_mm) refuse();
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return {number, zero};
}

}  // namespace

cl::ClReaderOptions reader_options(const ClFileOptions& options) {
  cl::ClReaderOptions out;
  out.nc = nc::reader_of_programs();
  if (!options.dialect.empty()) out.dialect = cl::find_dialect(options.dialect);
  if (options.units == "mm") out.unit = cl::LengthUnit::kMillimetre;
  if (options.units == "inch") out.unit = cl::LengthUnit::kInch;
  if (options.arc_sense == "right") out.arc_sense = cl::ArcSense::kRight;
  if (options.arc_sense == "left") out.arc_sense = cl::ArcSense::kLeft;
  if (options.feed_mm_per_min) {
    out.default_feed_mm_per_s = units::per_s_from_per_min(*options.feed_mm_per_min);
  }
  out.allowed_words = options.allow_unknown;
  out.allow_no_end = options.allow_no_end;
  out.first_line = options.first_line;
  for (const std::string& zero : options.work_zeros) out.work_offsets.insert(parse_work_zero(zero));
  if (!options.frame.empty()) {
    const RigidTransform frame = config::parse_frame(options.frame);
    out.frame = cl::Frame{frame.rotation, frame.origin_mm};
  }
  return out;
}

}  // namespace meridian::cli
