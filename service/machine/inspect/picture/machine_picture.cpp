// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/picture/machine_picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "service/analysis/plot/gnuplot.hpp"
#include "service/machine/inspect/point_block.hpp"

namespace meridian::inspect {
namespace {

using plot::quoted;

/// One line of a block of labels.
std::string label(const Vector3& at, const std::string& text) {
  std::string clean;
  for (const char c : text) clean += c == '"' || c == '\\' ? '_' : c;
  char line[100];
  std::snprintf(line, sizeof line, "%.6g %.6g %.6g \"", at[0], at[1], at[2]);
  return line + clean + "\"\n";
}

/// What all views show: a cube around the machine.
struct Scene {
  const MachineModel& model;
  const Skeleton& skeleton;
  Vector3 middle;
  double length = 100;  ///< of a drawn axis
  double half = 100;    ///< of the cube's edge

  Scene(const MachineModel& m, const Skeleton& s) : model(m), skeleton(s) {
    Vector3 low = s.tip, high = s.tip;
    const auto hold = [&](const Vector3& p) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    };
    hold(s.gauge);
    for (const Vector3& p : s.table) hold(p);
    for (const Vector3& p : s.arm) hold(p);
    middle = 0.5 * (low + high);
    length = std::max(0.2 * (high - low).maxCoeff(), 30.0);
    half = 0.5 * (high - low).maxCoeff() + 1.5 * length;
  }

  [[nodiscard]] const std::string& name(const SkeletonJoint& joint) const {
    return model.joints[static_cast<std::size_t>(joint.joint)].name;
  }

  [[nodiscard]] bool has(bool is_table) const {
    return std::any_of(
        skeleton.joints.begin(), skeleton.joints.end(),
        [is_table](const SkeletonJoint& j) { return (j.side == Side::kTable) == is_table; });
  }

  /// Where a linear joint's arrow starts: beside what it moves, clear of the rest.
  [[nodiscard]] Vector3 anchor(const SkeletonJoint& joint) const {
    const Vector3 aside{1.6 * length, 1.6 * length, 0};
    return joint.side == Side::kTable ? Vector3(skeleton.table.front() - aside)
                                      : Vector3(skeleton.arm.back() + aside);
  }
};

/// The arc of a positive turn round the end of an axis; `head` is its last piece.
std::vector<Vector3> arc(const Scene& scene, const SkeletonJoint& joint, std::string& head) {
  constexpr int kPieces = 24, kHead = 3;
  const Vector3 middle = joint.point + 0.8 * scene.length * joint.direction;
  const Vector3 first = 0.25 * scene.length * joint.direction.unitOrthogonal();
  std::vector<Vector3> out;
  for (int i = 0; i <= kPieces; ++i) {
    const double angle = 1.5 * std::numbers::pi * i / kPieces;
    out.push_back(middle + std::cos(angle) * first +
                  std::sin(angle) * joint.direction.cross(first));
  }
  const Vector3 from = out[kPieces - kHead], by = out[kPieces] - from;
  char text[160];
  std::snprintf(text, sizeof text, "%.6g %.6g %.6g %.6g %.6g %.6g\n", from[0], from[1], from[2],
                by[0], by[1], by[2]);
  head += text;
  out.resize(kPieces - kHead + 1);
  return out;
}

/// Joints of one side: $axesN, $arcsN, $arrowsN, $labelsN.
void print_joints(std::FILE* out, const Scene& scene, bool is_table) {
  const double length = scene.length;
  std::vector<Vector3> axes, arcs;
  const Vector3 gap = gap_of_block();
  std::string arrows, labels;
  for (const SkeletonJoint& joint : scene.skeleton.joints) {
    if ((joint.side == Side::kTable) != is_table) continue;
    const Vector3 from = joint.is_rotary ? joint.point : scene.anchor(joint);
    const Vector3 by = length * joint.direction;
    if (joint.is_rotary) {
      axes.insert(axes.end(), {from - by, from + by, gap});
      for (const Vector3& p : arc(scene, joint, arrows)) arcs.push_back(p);
      arcs.push_back(gap);
    } else {
      char text[160];
      std::snprintf(text, sizeof text, "%.6g %.6g %.6g %.6g %.6g %.6g\n", from[0], from[1], from[2],
                    by[0], by[1], by[2]);
      arrows += text;
    }
    labels += label(from + 1.15 * by, scene.name(joint));
  }
  const char* side = is_table ? "t" : "h";
  print_block(out, std::string("axes") + side, axes);
  print_block(out, std::string("arcs") + side, arcs);
  std::fprintf(out, "$arrows%s << EOD\nNaN NaN NaN NaN NaN NaN\n%sEOD\n", side, arrows.c_str());
  std::fprintf(out, "$labels%s << EOD\nNaN NaN NaN \"\"\n%sEOD\n", side, labels.c_str());
}

void print_scene(std::FILE* out, const Scene& scene) {
  const Skeleton& s = scene.skeleton;
  print_joints(out, scene, true);
  print_joints(out, scene, false);
  print_block(out, "table", s.table);
  print_block(out, "arm", s.arm);
  print_block(out, "tool", {s.gauge, s.tip});
  print_block(out, "tip", {s.tip});
  std::vector<Vector3> pivots;
  for (const SkeletonJoint& joint : s.joints) {
    if (joint.is_rotary) pivots.push_back(joint.point);
  }
  print_block(out, "pivots", pivots);
  const Vector3& origin = scene.model.X_MW.origin_mm;
  std::string labels;
  std::fputs("$frame << EOD\n", out);
  for (int i = 0; i < 3; ++i) {
    const Vector3 by = 0.6 * scene.length * scene.model.X_MW.rotation.col(i);
    print_point(out, origin);
    std::fputs(" ", out);
    print_point(out, by);
    std::fputs("\n", out);
    labels += label(origin + 1.3 * by, std::string(1, "xyz"[i]));
  }
  std::fprintf(out, "EOD\n$framelabels << EOD\n%sEOD\n", labels.c_str());
}

/// One plot of the scene; `columns` are those of a point ("1:2:3"), `vectors` with their ways.
std::string plot(const Scene& scene, const char* verb, const std::string& columns,
                 const std::string& vectors) {
  const std::string u = " using " + columns, v = " using " + vectors;
  std::string out = verb;
  out += " $table" + u + " with lines lw 6 lc '#c9d6e6' title 'workpiece to its pivots', ";
  out += "$arm" + u + " with lines lw 6 lc '#dddddd' title 'pivots to the gauge line', ";
  out += "$tool" + u + " with lines lw 3 lc '#555555' title 'tool', ";
  out += "$tip" + u + " with points pt 7 ps 1.1 lc '#c22f4f' title 'tip', ";
  out += "$pivots" + u + " with points pt 6 ps 1.4 lc '#333333' title 'pivots', ";
  for (const auto& [side, colour, what] : {std::array{"t", "#1f5fa8", "moves the workpiece"},
                                           std::array{"h", "#c8640a", "moves the tool"}}) {
    if (!scene.has(*side == 't')) continue;
    const std::string c = std::string(" lc '") + colour + "'";
    out += std::string("$axes") + side + u + " with lines dt 4" + c + " notitle, $arcs" + side + u +
           " with lines lw 1.6" + c + " title '" + what + "', $arrows" + side + v +
           " with vectors head filled lw 1.8" + c + " notitle, $labels" + side + u +
           ":4 with labels left font ',13' tc '" + colour + "' offset char " +
           (*side == 't' ? "1.2,-0.8" : "1.2,0.8") + " notitle, ";
  }
  out += "$frame" + v + " with vectors head lw 1.2 lc '#2a9d5c' title 'workpiece frame', ";
  return out + "$framelabels" + u + ":4 with labels font ',10' tc '#2a9d5c' notitle\n";
}

}  // namespace

std::optional<std::string> draw(const MachineModel& model, const Skeleton& skeleton,
                                const std::string& file) {
  const Scene scene(model, skeleton);
  const char* where = model.family == MachineFamily::kRobot ? "at home" : "every joint at zero";
  const std::string title = model.name + ", " + where + "; arrows: positive motion";
  const auto error = plot::draw(file, {1200, 1000, 14, 10}, [&](std::FILE* out) {
    print_scene(out, scene);
    std::fprintf(out, "set multiplot title %s\nset border lc '#888888'\n", quoted(title).c_str());
    print_four_views(out, scene.middle, scene.half, [&](const char* verb, const View& view) {
      return plot(scene, verb, view.points(), view.vectors());
    });
  });
  return error ? std::optional(error->text()) : std::nullopt;
}

}  // namespace meridian::inspect
