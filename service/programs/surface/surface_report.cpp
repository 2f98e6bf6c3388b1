// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/surface_report.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/units.hpp"
#include "service/text/printed.hpp"

namespace meridian::surface {

using text::printed;
namespace {

double angle_between(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

std::string radius(double mm) { return std::isfinite(mm) ? printed("%.6g mm", mm) : "none"; }

/// Adds one contact, and the block that leads to it from `last`.
class Measure {
 public:
  Measure(const PatchJob& job, SurfaceReport& report) : job_(job), report_(report) {
    report_.min_tilt_rad = std::numeric_limits<double>::infinity();
  }

  void add(const Contact& c, double& chord_error_mm, bool is_joined) {
    ++report_.contacts;
    min_ = std::min(min_, c.shape.min_curvature);
    largest_ = std::max(largest_, c.shape.largest_curvature);
    const double tilt = angle_between(c.pose.axis, Vector3::UnitZ());
    report_.min_tilt_rad = std::min(report_.min_tilt_rad, tilt);
    report_.largest_tilt_rad = std::max(report_.largest_tilt_rad, tilt);
    const double clearance = clearance_curvature(job_.rule.cutter, c.shape, c.pose.axis);
    if (clearance < -kGougeCurvature) {
      ++report_.gouges;
      if (clearance < worst_) {
        worst_ = clearance;
        report_.worst_gouge = c;
      }
    }
    if (last_ != nullptr && is_joined) {
      report_.length_mm += (c.pose.tip - last_->pose.tip).norm();
      report_.largest_turn_rad =
          std::max(report_.largest_turn_rad, angle_between(c.pose.axis, last_->pose.axis));
      if (const auto error = chord_error(job_.rule, *last_, c)) {
        chord_error_mm = std::max(chord_error_mm, *error);
      }
    }
    last_ = &c;
  }

  void finish() {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    report_.convex_radius_mm = min_ < -kGougeCurvature ? -1 / min_ : kNone;
    report_.concave_radius_mm = largest_ > kGougeCurvature ? 1 / largest_ : kNone;
    report_.seconds_at_feed = report_.length_mm / job_.program.feed_mm_per_s;
  }

 private:
  const PatchJob& job_;
  SurfaceReport& report_;
  const Contact* last_ = nullptr;
  double min_ = 0, largest_ = 0, worst_ = 0;
};

std::string asked(const char* what, double bound_mm) {
  return bound_mm > 0 ? printed(", %s %.6g mm", what, bound_mm) : "";
}

}  // namespace

SurfaceReport measure(const PatchJob& job, const SurfacePath& path) {
  SurfaceReport report;
  report.lines = path.lines.size();
  Measure measure(job, report);
  for (std::size_t i = 0; i < path.lines.size(); ++i) {
    const SurfacePath::Line& line = path.lines[i];
    bool is_first = true;
    for (const Contact& c : line.contacts) {
      measure.add(c, is_first ? report.crossing_chord_error_mm : report.chord_error_mm,
                  !is_first || path.is_zigzag);
      is_first = false;
    }
    for (const Contact& c : line.crossing) measure.add(c, report.crossing_chord_error_mm, true);
    if (i > 0) {
      const auto scallop =
          scallop_of_lines(job.rule, job.cover, path.lines[i - 1].parameter, line.parameter);
      if (scallop) report.scallop_mm = std::max(report.scallop_mm, *scallop);
    }
  }
  measure.finish();
  return report;
}

std::string to_text(const SurfaceReport& r, const PatchJob& job) {
  const NurbsNet& net = job.surface->net();
  const Cutter& cutter = job.rule.cutter;
  const char* kind = cutter.is_ball() ? "ball" : cutter.corner_radius_mm > 0 ? "toroidal" : "flat";
  std::string out = printed("surface   %s: degree %d x %d, %zu x %zu control points\n",
                            job.name.c_str(), net.degree_u, net.degree_v, net.rows, net.columns);
  out += "curvature smallest radius convex " + radius(r.convex_radius_mm) + ", concave " +
         radius(r.concave_radius_mm) + "\n";
  out += printed(
      "cutter    %s, diameter %.6g mm, corner radius %.6g mm; lead %.6g deg, tilt %.6g deg\n", kind,
      cutter.diameter_mm, cutter.corner_radius_mm, units::deg_from_rad(job.rule.lead_rad),
      units::deg_from_rad(job.rule.tilt_rad));
  out += printed("path      %s along %s: %zu lines, %zu contacts, %.3f mm, %.3f s at %.6g mm/min\n",
                 job.cover.is_zigzag ? "zigzag" : "one-way", job.rule.runs_along_u ? "u" : "v",
                 r.lines, r.contacts, r.length_mm, r.seconds_at_feed,
                 units::per_min_from_per_s(job.program.feed_mm_per_s));
  out += printed("axis      %.3f to %.3f deg from z, at most %.3f deg in one block\n",
                 units::deg_from_rad(r.min_tilt_rad), units::deg_from_rad(r.largest_tilt_rad),
                 units::deg_from_rad(r.largest_turn_rad));
  out += printed("chord     error at most %.6f mm on lines, %.6f mm between them%s\n",
                 r.chord_error_mm, r.crossing_chord_error_mm,
                 asked("asked", job.cover.chord_error_mm).c_str());
  out += std::isfinite(r.scallop_mm) ? printed("scallop   at most %.6f mm high", r.scallop_mm)
                                     : std::string("scallop   lines do not overlap");
  out += asked("asked", job.cover.scallop_mm) + "\n";
  if (r.gouges == 0) return out + "gouge     none: the cutter bends more than the surface\n";
  return out + printed(
                   "gouge     WARNING: %zu of %zu contacts: the cutter bends less than the "
                   "surface; worst at u = %.6g, v = %.6g, where the surface has radius %s\n",
                   r.gouges, r.contacts, r.worst_gouge.u, r.worst_gouge.v,
                   radius(1 / r.worst_gouge.shape.largest_curvature).c_str());
}

}  // namespace meridian::surface
