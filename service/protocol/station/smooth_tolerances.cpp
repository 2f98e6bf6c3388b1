// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/station/smooth_tolerances.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "meridian/kinematics/kinematics.hpp"

namespace meridian::stream {
namespace {

struct ToleranceBounds {
  const char *name, *unit;
  double min, max;
};
constexpr ToleranceBounds kTipBounds{"tip", "mm", kMinTipTolerance_mm, kMaxTipTolerance_mm};
constexpr ToleranceBounds kAxisBounds{"axis", "rad", kMinAxisTolerance_rad, kMaxAxisTolerance_rad};

/// With as many digits as distinguish `value` from every other number, six at least.
std::string in_full(double value) {
  char text[32];
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

std::string refusal_of(const ToleranceBounds& bounds, double asked, double of_machine,
                       bool is_smooth) {
  const bool is_asked = asked != 0;
  if (!is_asked && !is_smooth) return {};
  const double value = is_asked ? asked : of_machine;
  if (value > 0 && value <= bounds.max && (!is_smooth || value >= bounds.min)) return {};
  return std::string(bounds.name) + " tolerance of the " + (is_asked ? "program" : "machine") +
         " is " + in_full(value) + " " + bounds.unit + "; allowed is " +
         (is_smooth ? in_full(bounds.min) + " to " : "more than 0, up to ") + in_full(bounds.max) +
         " " + bounds.unit + (is_smooth ? " where a run is smooth" : "") +
         (is_asked ? ", or 0 for the machine's" : "");
}

}  // namespace

std::string refusal_of_tolerances(const MachineModel& model, Transition transition, double tip_mm,
                                  double axis_rad) {
  const bool is_smooth = transition == Transition::kSmooth;
  std::string tip = refusal_of(kTipBounds, tip_mm, model.tolerances.tip_mm, is_smooth);
  if (!tip.empty()) return tip;
  // On a pole that the tool axis misses, so much of it is used already.
  ToleranceBounds axis = kAxisBounds;
  axis.min += std::abs(pole_offset_rad(model));
  return refusal_of(axis, axis_rad, model.tolerances.axis_rad, is_smooth);
}

}  // namespace meridian::stream
