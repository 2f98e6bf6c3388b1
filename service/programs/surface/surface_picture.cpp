// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/surface_picture.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "service/analysis/plot/gnuplot.hpp"
#include "service/programs/surface/surface_report.hpp"

namespace meridian::surface {
namespace {

constexpr int kMesh = 40;           // pieces of the drawn surface, either way
constexpr std::size_t kAxes = 150;  // drawn at most
constexpr double kMicrometre_mm = 1e-3;
constexpr double kMetre_mm = 1e3;

/// $surface: u v x y z curvature over a mesh of the whole patch; no value where there is no normal.
void print_surface(std::FILE* out, const PatchJob& job) {
  const auto [u0, u1] = job.surface->domain_u();
  const auto [v0, v1] = job.surface->domain_v();
  std::fputs("$surface << EOD\n", out);
  for (int i = 0; i <= kMesh; ++i) {
    for (int j = 0; j <= kMesh; ++j) {
      const double u = u0 + (u1 - u0) * i / kMesh, v = v0 + (v1 - v0) * j / kMesh;
      const Vector3 at = job.surface->evaluate(u, v).at;
      std::fprintf(out, "%.6g %.6g %.7g %.7g %.7g ", u, v, at[0], at[1], at[2]);
      const auto shape = shape_at(*job.surface, u, v, job.rule.is_flipped);
      if (shape) {
        std::fprintf(out, "%.6g\n", shape->largest_curvature * kMetre_mm);
      } else {
        std::fputs("NaN\n", out);
      }
    }
    std::fputs("\n", out);
  }
  std::fputs("EOD\n", out);
}

/// $tips, $axes (with `length_mm` of each axis), $gouges, $chords (block, micrometres).
void print_path(std::FILE* out, const PatchJob& job, const SurfacePath& path, double length_mm) {
  const std::vector<const Contact*> contacts = in_order(path);
  std::fputs("$tips << EOD\n", out);
  for (const SurfacePath::Line& line : path.lines) {
    for (const auto* part : {&line.contacts, &line.crossing}) {
      for (const Contact& c : *part) {
        std::fprintf(out, "%.7g %.7g %.7g\n", c.pose.tip[0], c.pose.tip[1], c.pose.tip[2]);
      }
    }
    if (!path.is_zigzag) std::fputs("\n", out);
  }
  std::fputs("EOD\n$axes << EOD\n", out);
  const std::size_t stride = 1 + contacts.size() / kAxes;
  for (std::size_t i = 0; i < contacts.size(); i += stride) {
    const Vector3 a = contacts[i]->pose.tip, b = length_mm * contacts[i]->pose.axis;
    std::fprintf(out, "%.7g %.7g %.7g %.6g %.6g %.6g\n", a[0], a[1], a[2], b[0], b[1], b[2]);
  }
  std::fputs("EOD\n$gouges << EOD\nNaN NaN NaN\n", out);
  for (const Contact* c : contacts) {
    if (clearance_curvature(job.rule.cutter, c->shape, c->pose.axis) >= -kGougeCurvature) continue;
    std::fprintf(out, "%.7g %.7g %.7g\n", c->shape.at[0], c->shape.at[1], c->shape.at[2]);
  }
  std::fputs("EOD\n$chords << EOD\n", out);
  for (std::size_t i = 1; i < contacts.size(); ++i) {
    const bool is_joined = path.is_zigzag || (contacts[i - 1]->u == contacts[i]->u) !=
                                                 (contacts[i - 1]->v == contacts[i]->v);
    const auto error =
        is_joined ? chord_error(job.rule, *contacts[i - 1], *contacts[i]) : std::optional<double>();
    if (error) std::fprintf(out, "%zu %.6g\n", i, *error / kMicrometre_mm);
  }
  std::fputs("EOD\n", out);
}

/// $wrists, never empty.
void print_wrists(std::FILE* out, const std::vector<WristPoint>& wrists) {
  std::fputs("$wrists << EOD\nNaN NaN NaN\n", out);
  for (const WristPoint& p : wrists) {
    std::fprintf(out, "%.7g %.7g %.7g\n", p.at[0], p.at[1], p.at[2]);
  }
  std::fputs("EOD\n", out);
}

void print_script(std::FILE* out, const PatchJob& job, const SurfacePath& path,
                  const std::vector<WristPoint>& wrists) {
  print_surface(out, job);
  print_wrists(out, wrists);
  print_path(out, job, path, 0.06 * job.surface->size_mm());
  std::fprintf(out, "set multiplot title %s\n", plot::quoted(job.name).c_str());
  std::fputs(
      "set grid lc '#dddddd'\nset border lc '#555555'\nset size ratio 0\n"
      "set origin 0,0\nset size 0.6,0.95\nset view equal xyz\nset view 58,35,1.38\n"
      "set xyplane relative 0.05\nset xlabel 'x, mm'\nset ylabel 'y, mm'\nset zlabel 'z, mm' "
      "offset 4,0\n"
      "set key at screen 0.03,0.93 left top samplen 2\n"
      "splot $surface using 3:4:5 with lines lw 0.4 lc '#c8c8c8' title 'patch', "
      "$axes using 1:2:3:4:5:6 with vectors nohead lw 0.8 lc '#e08214' title 'tool axis', "
      "$tips using 1:2:3 with lines lw 1.3 lc '#1f5fa8' title 'tip', "
      "$gouges using 1:2:3 with points pt 7 ps 0.6 lc '#c22f4f' title 'gouge'",
      out);
  if (!wrists.empty()) {
    std::fputs(", $wrists using 1:2:3 with points pt 7 ps 0.4 lc '#2a9d5c' title 'wrist, S + dN'",
               out);
  }
  std::fputs(
      "\n"
      "unset view\nunset key\nunset zlabel\nset view map\n"
      "set origin 0.62,0.42\nset size 0.37,0.53\nset xlabel 'u'\nset ylabel 'v'\n"
      "set title 'largest principal curvature, 1/m; positive: towards the cutter'\n"
      "set palette defined (0 '#2166ac', 1 '#f7f7f7', 2 '#b2182b')\n",
      out);
  std::fputs(
      "stats $surface using 6 nooutput\nbend = abs(STATS_max) > abs(STATS_min) ? abs(STATS_max) : "
      "abs(STATS_min)\nif (bend < 1e-6) bend = 1\nset cbrange [-bend:bend]\n"
      "stats $surface using 1 nooutput prefix 'U'\nstats $surface using 2 nooutput prefix 'V'\n"
      "set xrange [U_min:U_max]\nset yrange [V_min:V_max]\n"
      "plot $surface using 1:2:6 with image notitle\n"
      "unset title\nunset view\nunset colorbox\n"
      "set xrange [*:*]\nset origin 0.62,0.03\nset size 0.37,0.37\nset xlabel 'block'\n"
      "set ylabel 'chord error, um'\nset yrange [0:*]\n"
      "plot $chords using 1:2 with impulses lc '#1f5fa8' notitle\n",
      out);
}

}  // namespace

std::optional<std::string> draw(const PatchJob& job, const SurfacePath& path,
                                const std::vector<WristPoint>& wrists, const std::string& file) {
  const auto error = plot::draw(file, {1500, 850, 14, 11},
                                [&](std::FILE* out) { print_script(out, job, path, wrists); });
  return error ? std::optional(error->text()) : std::nullopt;
}

}  // namespace meridian::surface
