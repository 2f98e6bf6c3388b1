// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/path/band_spline.hpp"
#include "meridian/path/pose_at.hpp"

namespace meridian::test {

inline ToolPose pose_of(const ClBlock& block) {
  return {to_vector(block.tip_mm), to_vector(block.axis)};
}

/// Everything that a spline handed out.
struct BandRun {
  std::vector<BandSpan> spans;
  std::vector<BlockEnd> ends;

  [[nodiscard]] double end() const {
    return spans.empty() ? 0 : spans.back().u0 + spans.back().length;
  }
  void take_all(BandSpline& spline) {
    while (const BandSpan* span = spline.next()) {
      spans.push_back(*span);
      while (const auto end = spline.next_block_end()) ends.push_back(*end);
    }
  }
};

/// The path through `blocks` from the first on; `take` says after which blocks spans are taken.
template <class Take>
BandRun run_band(BandSpline& spline, const std::vector<ClBlock>& blocks,
                 const BandTolerance& tolerance, Take take) {
  BandRun run;
  spline.begin(pose_of(blocks.front()), tolerance);
  for (std::size_t n = 1; n < blocks.size(); ++n) {
    while (!spline.push(blocks[n])) run.take_all(spline);
    if (take(n)) run.take_all(spline);
  }
  spline.finish();
  run.take_all(spline);
  return run;
}

inline BandRun run_band(const std::vector<ClBlock>& blocks, const BandTolerance& tolerance = {},
                        const BandTuning& tuning = {}) {
  BandSpline spline(tuning);
  return run_band(spline, blocks, tolerance, [](std::size_t) { return true; });
}

/// Distance of two poses, the larger of tip and axis in tolerances.
inline double distance(const ToolPose& a, const ToolPose& b, const BandTolerance& tolerance) {
  return std::max((a.tip - b.tip).norm() / tolerance.tip_mm,
                  angle_between(a.axis, b.axis) / tolerance.axis_rad);
}

/// The programmed path: lines of the tip with the axis on the great circle, independent of the
/// smoother's own polyline.
class ProgrammedPath {
 public:
  explicit ProgrammedPath(const std::vector<ClBlock>& blocks) {
    for (const ClBlock& block : blocks) {
      const ToolPose pose = pose_of(block);
      if (!poses_.empty()) {
        const double tip = (pose.tip - poses_.back().tip).norm();
        const double turn = angle_between(pose.axis, poses_.back().axis);
        const double length = std::hypot(tip, 50 * turn);
        if (length < 1e-6) continue;
        u_.push_back(u_.back() + length);
        circles_.push_back(find_great_circle(poses_.back().axis, pose.axis));
      } else {
        u_.push_back(0);
      }
      poses_.push_back(pose);
    }
  }

  /// Matched distance of `pose` from the path near length `u`: over all poses of the path the least
  /// of the larger of tip and axis, in tolerances.
  [[nodiscard]] double distance_to(const ToolPose& pose, double u,
                                   const BandTolerance& tolerance) const {
    const auto from = std::upper_bound(u_.begin(), u_.end(), u - 0.1);
    const auto to = std::upper_bound(u_.begin(), u_.end(), u + 0.1);
    const std::size_t last = circles_.size();
    const std::size_t low =
        from == u_.begin() ? 0 : static_cast<std::size_t>(from - u_.begin()) - 1;
    const std::size_t high = std::min(last, static_cast<std::size_t>(to - u_.begin()) + 1);
    double min = 1e9;
    for (std::size_t i = std::min(low, last - 1); i < high; ++i) {
      const auto at = [&](double x) { return distance(pose, point(i, x), tolerance); };
      min = std::min(min, min_of(at));
    }
    return min;
  }

  [[nodiscard]] double length() const { return u_.back(); }

 private:
  [[nodiscard]] ToolPose point(std::size_t i, double x) const {
    const GreatCircle& circle = circles_[i];
    return {poses_[i].tip + x * (poses_[i + 1].tip - poses_[i].tip),
            axis_on_circle(circle.begin, circle.normal, x * circle.turn)};
  }

  /// Least value over [0, 1] of a function that falls, then rises (golden section).
  template <class F>
  static double min_of(F f) {
    constexpr double kGolden = 0.6180339887498949;
    double low = 0, high = 1, a = 1 - kGolden, b = kGolden, fa = f(a), fb = f(b);
    for (int n = 0; n < 40 && high - low > 1e-7; ++n) {
      if (fa < fb) {
        high = b, b = a, fb = fa, a = low + (1 - kGolden) * (high - low), fa = f(a);
      } else {
        low = a, a = b, fa = fb, b = low + kGolden * (high - low), fb = f(b);
      }
    }
    return std::min({fa, fb, f(0), f(1)});
  }

  std::vector<ToolPose> poses_;
  std::vector<double> u_;
  std::vector<GreatCircle> circles_;
};

/// The pose of `run` at `u`.
inline ToolPose pose_at_u(const BandRun& run, double u) {
  const auto after = std::upper_bound(run.spans.begin(), run.spans.end(), u,
                                      [](double x, const BandSpan& s) { return x < s.u0; });
  const BandSpan& span = after == run.spans.begin() ? *after : *(after - 1);
  return pose_on(span.c, u - span.u0);
}

}  // namespace meridian::test
