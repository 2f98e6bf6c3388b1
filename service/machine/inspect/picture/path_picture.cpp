// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/picture/path_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "service/analysis/plot/gnuplot.hpp"
#include "service/machine/inspect/point_block.hpp"

namespace meridian::inspect {
namespace {

/// A cube around all points.
struct Cube {
  Vector3 middle = Vector3::Zero();
  double half = 100;
};

void print_posture(std::FILE* out, const MachinePosture& posture, const std::string& number) {
  print_block(out, "head" + number, posture.head);
  print_block(out, "tool" + number, {posture.head.back(), posture.tip});
  print_block(out, "table" + number, posture.table);
  std::vector<Vector3> rods, sliders;
  if (posture.stage) {
    for (std::size_t n = 0; n < posture.stage->slider.size(); ++n) {
      rods.insert(rods.end(), {posture.stage->slider[n], posture.stage->pin[n],
                               posture.stage->centre, gap_of_block()});
      sliders.push_back(posture.stage->slider[n]);
    }
  }
  print_block(out, "rods" + number, rods);
  print_block(out, "sliders" + number, sliders);
}

[[nodiscard]] Cube cube_of(const std::vector<MachinePosture>& postures) {
  Vector3 low = postures.front().tip, high = low;
  const auto hold = [&](const Vector3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  for (const MachinePosture& posture : postures) {
    hold(posture.tip);
    for (const Vector3& p : posture.head) hold(p);
    for (const Vector3& p : posture.table) hold(p);
    if (!posture.stage) continue;
    for (const Vector3& p : posture.stage->slider) hold(p);
    for (const Vector3& p : posture.stage->pin) hold(p);
  }
  return {0.5 * (low + high), std::max(0.55 * (high - low).maxCoeff(), 50.0)};
}

/// Pale to dark, as gnuplot writes a colour.
[[nodiscard]] std::string shade(const std::array<int, 3>& colour, double share) {
  std::array<int, 3> mixed{};
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    mixed[i] = static_cast<int>(std::lround(235 + (colour[i] - 235) * (0.2 + 0.8 * share)));
  }
  char text[16];
  std::snprintf(text, sizeof text, "'#%02x%02x%02x'", mixed[0], mixed[1], mixed[2]);
  return text;
}

/// One plot of all points; `columns` are those of a point.
[[nodiscard]] std::string plot_of(const std::vector<MachinePosture>& postures, const char* verb,
                                  const std::string& columns) {
  constexpr std::array<int, 3> kHead{200, 100, 10}, kTable{31, 95, 168}, kTool{60, 60, 60};
  std::string out = verb;
  for (std::size_t n = 0; n < postures.size(); ++n) {
    const double share = static_cast<double>(n + 1) / static_cast<double>(postures.size());
    const bool is_last = n + 1 == postures.size();
    const auto add = [&](const char* block, const std::string& style, const char* title) {
      out += (out == verb ? " $" : ", $") + std::string(block) + std::to_string(n) + " using " +
             columns + style + (is_last ? std::string(" title '") + title + "'" : " notitle");
    };
    const std::string head = shade(kHead, share), table = shade(kTable, share);
    add("table", " with linespoints pt 6 ps 0.7 lw 2 lc " + table, "carries the workpiece");
    if (postures[n].stage) {
      add("rods", " with lines lw 2 dt 2 lc " + table, "rods to the table");
      add("sliders", " with points pt 5 ps 1 lc " + table, "sliders");
    }
    add("head", " with linespoints pt 6 ps 0.9 lw 3 lc " + head, "carries the tool");
    add("tool", " with lines lw 3 lc " + shade(kTool, share), "tool");
  }
  return out + ", $path using " + columns +
         " with linespoints pt 7 ps 0.5 lc '#c22f4f' title 'tip'\n";
}

}  // namespace

std::optional<std::string> draw_along(const MachineModel& model,
                                      const std::vector<MachinePosture>& postures,
                                      const std::string& file) {
  const Cube cube = cube_of(postures);
  const std::string title = model.name + " from line " + std::to_string(postures.front().line) +
                            " to line " + std::to_string(postures.back().line) +
                            ", pale to dark; frame of the machine";
  const auto error = plot::draw(file, {1200, 1000, 14, 10}, [&](std::FILE* out) {
    std::vector<Vector3> tips;
    for (std::size_t n = 0; n < postures.size(); ++n) {
      print_posture(out, postures[n], std::to_string(n));
      tips.push_back(postures[n].tip);
    }
    print_block(out, "path", tips);
    std::fprintf(out, "set multiplot title %s\nset border lc '#888888'\n",
                 plot::quoted(title).c_str());
    print_four_views(out, cube.middle, cube.half, [&](const char* verb, const View& view) {
      return plot_of(postures, verb, view.points());
    });
  });
  return error ? std::optional(error->text()) : std::nullopt;
}

}  // namespace meridian::inspect
