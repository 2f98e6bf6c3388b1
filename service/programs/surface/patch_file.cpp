// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/patch_file.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "meridian/units.hpp"
#include "service/machine/file/section.hpp"

namespace meridian::surface {
namespace {

using config::Range;
using config::Section;

constexpr std::size_t kMaxPoints = 1000;  // of the net, either way
constexpr Range kPosition_mm{-1e5, 1e5};
constexpr Range kWeight{1e-6, 1e6};
constexpr Range kKnot{-1e6, 1e6};
constexpr Range kStep_mm{1e-6, 1e3};
constexpr Range kLean_deg{-80, 80};

void read_row(Section& row, NurbsNet& net) {
  const bool is_first = net.rows == 0;
  const std::size_t min = is_first ? 2 : net.columns;
  const std::size_t max = is_first ? kMaxPoints : net.columns;
  const std::string all = "all rows have as many points as the first";
  const std::vector<double> x = row.numbers("x_mm", min, max, kPosition_mm, all);
  net.columns = x.size();
  const std::vector<double> y = row.numbers("y_mm", x.size(), x.size(), kPosition_mm, all);
  const std::vector<double> z = row.numbers("z_mm", x.size(), x.size(), kPosition_mm, all);
  std::vector<double> weights(x.size(), 1.0);
  if (row.has("weight")) {
    weights = row.numbers("weight", x.size(), x.size(), kWeight,
                          "one for each point; 1 is a plain B-spline");
  }
  row.finish();
  for (std::size_t i = 0; i < x.size(); ++i) net.points.emplace_back(x[i], y[i], z[i]);
  net.weights.insert(net.weights.end(), weights.begin(), weights.end());
  ++net.rows;
}

const char* key_of(NurbsFault::Part part) {
  switch (part) {
    case NurbsFault::Part::kDegree:
      return "degree";
    case NurbsFault::Part::kKnotsU:
      return "knots_u";
    case NurbsFault::Part::kKnotsV:
      return "knots_v";
    case NurbsFault::Part::kPoints:
    case NurbsFault::Part::kWeights:
      break;
  }
  return "row";
}

void read_surface(Section section, PatchJob& job) {
  job.name = section.text("name");
  NurbsNet net;
  const Range degree{1, kMaxDegree};
  const std::vector<double> degrees = section.numbers("degree", 2, 2, degree, "write [u, v]");
  net.degree_u = static_cast<int>(degrees[0]);
  net.degree_v = static_cast<int>(degrees[1]);
  if (net.degree_u != degrees[0] || net.degree_v != degrees[1]) {
    section.refuse("degree", "two whole numbers, 1 to 9", "write [3, 3] for a bicubic patch");
  }
  const std::size_t max = kMaxPoints + kMaxDegree + 1;
  net.knots_u = section.numbers("knots_u", 4, max, kKnot);
  net.knots_v = section.numbers("knots_v", 4, max, kKnot);
  job.rule.is_flipped = section.truth_or("flip_normal", false);
  std::vector<Section> rows = section.sections_or("row");
  if (rows.size() < 2 || rows.size() > kMaxPoints) {
    section.refuse("row", "2 to 1000 tables [[surface.row]], one for each control point along u",
                   "write x_mm, y_mm, z_mm and weight of all points along v into each");
  }
  for (Section& row : rows) read_row(row, net);
  auto made = NurbsSurface::create(std::move(net));
  if (!made) {
    section.refuse(key_of(made.error().part), made.error().allowed, made.error().remedy);
  }
  job.surface = std::make_shared<const NurbsSurface>(std::move(*made));
  job.rule.surface = job.surface.get();
  section.finish();
}

void read_cutter(Section section, PatchJob& job) {
  Cutter& cutter = job.rule.cutter;
  const int kind = section.choice("kind", {"ball", "toroidal", "flat"});
  cutter.diameter_mm = section.number("diameter_mm", {1e-3, 1e3});
  const double radius = cutter.radius_mm();
  if (kind == 1) {
    cutter.corner_radius_mm = section.number("corner_radius_mm", {1e-3, radius},
                                             "0 is a flat cutter, half the diameter a ball end");
  } else {
    if (section.has("corner_radius_mm")) {
      section.refuse("corner_radius_mm", "nothing: only a toroidal cutter has one of its own",
                     "remove the key, or write kind = \"toroidal\"");
    }
    cutter.corner_radius_mm = kind == 0 ? radius : 0;
  }
  job.rule.lead_rad = units::rad_from_deg(section.number_or("lead_deg", 0, kLean_deg));
  job.rule.tilt_rad = units::rad_from_deg(section.number_or("tilt_deg", 0, kLean_deg));
  job.program.tool_number = section.integer_or("number", 0, 1, 999'999'999);
  job.program.spindle_rpm = section.number_or("spindle_rpm", 0, {1, 1e6});
  section.finish();
}

/// One of two keys: a count or a bound.
void read_spacing(Section& section, const char* count_key, const char* bound_key,
                  std::size_t& count, double& bound_mm) {
  const bool has_count = section.has(count_key), has_bound = section.has(bound_key);
  if (has_count == has_bound) {
    section.refuse(count_key, std::string("either ") + count_key + " or " + bound_key,
                   has_count ? "remove one of the two" : "add one of the two");
  }
  count = static_cast<std::size_t>(section.integer_or(count_key, 0, 2, 100'000));
  bound_mm = section.number_or(bound_key, 0, kStep_mm);
}

std::array<double, 2> read_range(Section& section, const char* key,
                                 const std::array<double, 2>& domain) {
  if (!section.has(key)) {
    (void)section.number_or(key, 0, {});  // a key that may be there
    return domain;
  }
  const auto range = section.pair(key, {domain[0], domain[1]}, "stay inside the knots");
  if (!(range[0] < range[1])) section.refuse(key, "[minimum, maximum]", "put the smaller first");
  return range;
}

void read_path(Section section, PatchJob& job) {
  CoverOptions& cover = job.cover;
  job.rule.runs_along_u = section.choice("along", {"u", "v"}) == 0;
  cover.is_zigzag = section.choice_or("pattern", 0, {"zigzag", "one-way"}) == 0;
  read_spacing(section, "points", "chord_error_mm", cover.points, cover.chord_error_mm);
  read_spacing(section, "lines", "scallop_mm", cover.lines, cover.scallop_mm);
  cover.range_u = read_range(section, "range_u", job.surface->domain_u());
  cover.range_v = read_range(section, "range_v", job.surface->domain_v());
  const Range feed{1e-3, 1e6};
  const double feed_mm_per_min = section.number("feed_mm_per_min", feed);
  job.program.feed_mm_per_s = units::per_s_from_per_min(feed_mm_per_min);
  job.program.plunge_feed_mm_per_s =
      units::per_s_from_per_min(section.number_or("plunge_feed_mm_per_min", feed_mm_per_min, feed));
  job.program.clearance_mm = section.number("clearance_mm", {0.1, 1e4});
  section.finish();
}

PatchJob read_file(const toml::table& table, const std::string& name) {
  Section file(name, table);
  PatchJob job;
  read_surface(file.section("surface"), job);
  read_cutter(file.section("cutter"), job);
  read_path(file.section("path"), job);
  file.finish();
  return job;
}

}  // namespace

PatchJob load_patch(const std::filesystem::path& path) {
  return read_file(config::parse_file(path), path.string());
}

PatchJob parse_patch(std::string_view text, const std::string& name) {
  return read_file(config::parse_text(text, name), name);
}

}  // namespace meridian::surface
