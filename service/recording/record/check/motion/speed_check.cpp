// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/motion/speed_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "meridian/geometry/great_circle.hpp"

namespace meridian::record {
namespace {

constexpr double kPosition_mm = 1e-11;  // of the tip, by rounding of the joints
constexpr double kMinFeed = 1e-12;      // mm/s
constexpr double kMinTurn_rad_per_s = 1e-9;
/// In inverse time blocks within this way of a point say how fast tip and axis may be there.
constexpr double kSpeedReach_mm = 5;
constexpr double kNoFeed = PathElement::kNoFeed;

/// How long the rate of plan time takes at most to follow an override: its ramp, and what it needs
/// to turn round, get going and settle.
[[nodiscard]] std::uint64_t ramp_cycles(const MachineModel& model) {
  constexpr double kSettle_s = 0.3;
  return static_cast<std::uint64_t>(1e9 * (model.override_ramp_s + kSettle_s)) /
         static_cast<std::uint64_t>(model.cycle_ns);
}

}  // namespace

SpeedCheck::SpeedCheck(const MachineModel& model, const CheckedPath& path,
                       const CheckOptions& options)
    : model_(model),
      path_(path),
      options_(options),
      period_(static_cast<double>(model.cycle_ns) * 1e-9),
      overrides_(options.overrides, ramp_cycles(model)) {}

/// The fastest that blocks on a stretch of the path ask for; where one is in inverse time also
/// those within reach, and where all are the axis is bounded too. No block in inverse time counts
/// for less than a tolerance over the reach.
SpeedCheck::Speeds SpeedCheck::asked_between(PathMatching::Position low,
                                             PathMatching::Position high) const noexcept {
  const auto& elements = path_.elements();
  std::size_t first = low.element, last = high.element;
  bool is_timed = false, bounds_axis = true;
  for (std::size_t i = first; i <= last; ++i) {
    is_timed = is_timed || elements[i].is_timed;
    bounds_axis = bounds_axis && elements[i].is_timed;
  }
  if (is_timed) {
    const auto has_feed = [&](std::size_t i) { return elements[i].feed_mm_per_s < kNoFeed; };
    const double from = elements[first].path_to(low.t) - kSpeedReach_mm;
    const double to = elements[last].path_to(high.t) + kSpeedReach_mm;
    while (first > 0 && elements[first].path_begin >= from && has_feed(first - 1)) --first;
    while (last + 1 < elements.size() && elements[last + 1].path_begin <= to && has_feed(last + 1))
      ++last;
  }
  Speeds out{0, bounds_axis ? 0 : kNoFeed};
  for (std::size_t i = first; i <= last; ++i) {
    const PathElement& element = elements[i];
    const double reaches_per_s = element.path_mm_per_s / kSpeedReach_mm;
    const double min_tip = element.is_timed ? options_.tip_tolerance_mm * reaches_per_s : 0;
    out.tip_mm_per_s = std::max({out.tip_mm_per_s, element.feed_mm_per_s, min_tip});
    out.turn_rad_per_s = std::max(
        {out.turn_rad_per_s, element.turn_rad_per_s, options_.axis_tolerance_rad * reaches_per_s});
  }
  return out;
}

void SpeedCheck::add(const ToolPose& from, const ToolPose& to, PathMatching::Position low,
                     PathMatching::Position high, std::uint64_t cycle, std::uint32_t line) {
  const double speed = (to.tip - from.tip).norm() / period_;
  speed_.raise(speed, cycle, line);
  if (path_.elements().empty()) return;
  const Speeds asked = asked_between(low, high);
  const double factor = options_.overrides.empty() ? options_.feed_factor : overrides_.at(cycle);
  double allowed = asked.tip_mm_per_s * factor;
  if (model_.max_feed_mm_per_s > 0 && std::isfinite(allowed)) {
    allowed = std::min(allowed, model_.max_feed_mm_per_s);
  }
  // At an override of 0 the tip stands but for the last bit of its place.
  const double use = std::max(0.0, speed - kPosition_mm / period_) / std::max(allowed, kMinFeed);
  feed_.raise(use, cycle, line);
  if (use > 1 + kRoundingShare) feed_over_.add(use, cycle, line);
  const double rate = angle_between(from.axis, to.axis) / period_;
  const double allowed_turn = asked.turn_rad_per_s * factor;
  if (rate > allowed_turn * (1 + kRoundingShare) + kMinTurn_rad_per_s) {
    turn_over_.add(rate / std::max(allowed_turn, kMinTurn_rad_per_s), cycle, line);
  }
}

void SpeedCheck::finish(CheckReport& report) const {
  report.feed = feed_;
  report.tip_speed_mm_per_s = speed_;
  char text[256];
  const auto find = [&](Finding::Kind kind, const Excess& excess) {
    report.findings.push_back({kind, text, excess.worst.cycle, excess.worst.line, excess.count});
  };
  if (feed_over_.count > 0) {
    std::snprintf(text, sizeof text, "tip speed is %.6f x the programmed feed%s in %llu cycles",
                  feed_over_.worst.value, options_.overrides.empty() ? "" : " times the override",
                  static_cast<unsigned long long>(feed_over_.count));
    find(Finding::Kind::kFeed, feed_over_);
  }
  if (turn_over_.count > 0) {
    std::snprintf(text, sizeof text, "tool axis turns %.6f x as fast as its inverse time allows",
                  turn_over_.worst.value);
    find(Finding::Kind::kTurnRate, turn_over_);
  }
}

}  // namespace meridian::record
