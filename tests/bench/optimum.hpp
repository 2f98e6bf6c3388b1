// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "bench/smooth_workload.hpp"
#include "service/core/planner/feed/cells/feed_rest.hpp"
#include "service/core/planner/feed/rolling/rolling_feed.hpp"
#include "service/core/planner/feed/solver/jerk_step.hpp"
#include "service/core/planner/feed/solver/two_pass.hpp"
#include "service/core/planner/singular/pole/pole_corridor.hpp"
#include "service/core/planner/singular/robot/robot_passes.hpp"

/// The least time over a smooth path, jerk included: the whole path in one window, linearised again
/// until nothing is gained, cells half as long. What the rolling planner takes is held against it.
namespace meridian::bench {

/// A smooth path whose spans are there, and where it starts.
struct SpanPath {
  RunStart start;
  std::vector<JointSpan> spans;
};

/// What a smooth run over blocks plans its feed on, made of them as it does.
class SpanMaker {
 public:
  SpanMaker(const MachineModel& model, const ClBlock& first)
      : model_(model), corridor_(model), passes_(model) {
    const RunStart& start = path_.start = start_at(model, first);
    BandTolerance tolerance;
    tolerance.tip_mm = model.tolerances.tip_mm;
    tolerance.axis_rad = model.tolerances.axis_rad;
    const bool relaxed_axes =
        redundant_joint(model) >= 0 && model.pole_policy == PolePolicy::kRelax;
    if (relaxed_axes) tolerance.pole = to_array(pole_direction(model));
    const double axis_rad = std::max(tolerance.axis_rad, model.tolerances.pole_axis_rad);
    band_.begin(start.pose, tolerance);
    corridor_.begin(
        {start.joints, start.branch, start.tool_length_mm, start.pose.axis, axis_rad, false});
    passes_.begin(
        {start.joints, start.branch, start.tool_length_mm, start.pose, axis_rad, tolerance.tip_mm});
  }

  [[nodiscard]] bool push(const ClBlock& block) {
    const bool is_taken = band_.push(block);
    take();
    return is_taken;
  }
  [[nodiscard]] SpanPath finish() {
    band_.finish();
    take();
    corridor_.finish();
    take();
    passes_.finish();
    take();
    return std::move(path_);
  }

 private:
  void take() {
    for (;;) {
      if (const JointSpan* span = passes_.next()) {
        path_.spans.push_back(*span);
      } else if (const JointSpan* led = corridor_.next()) {
        passes_.push(*led);
      } else if (const BandSpan* next = band_.next()) {
        mark_axes();
        BandSpan limited = *next;
        if (model_.max_feed_mm_per_s > 0) {
          limited.feed_mm_per_s = std::min(limited.feed_mm_per_s, model_.max_feed_mm_per_s);
        }
        corridor_.push(limited);
      } else {
        return;
      }
    }
  }
  void mark_axes() {
    while (const auto mark = band_.next_axis()) {
      if (!(mark->u > 0)) continue;
      corridor_.mark(mark->u, to_vector(mark->axis));
      passes_.mark(*mark);
    }
  }

  const MachineModel& model_;
  SpanPath path_;
  BandSpline band_;
  PoleCorridor corridor_;
  RobotPasses passes_;
};

[[nodiscard]] inline SpanPath spans_of(const MachineModel& model,
                                       const std::vector<ClBlock>& blocks) {
  const auto maker = std::make_unique<SpanMaker>(model, blocks.front());
  for (std::size_t n = 1; n < blocks.size(); ++n) {
    if (!maker->push(blocks[n])) return {};
  }
  return maker->finish();
}

/// Time and counts of the rolling planner.
struct RollingTime {
  double time_s = 0;
  FeedCount count;
  bool is_done = false;
};
[[nodiscard]] inline RollingTime rolling_time(const MachineModel& model, const SpanPath& path,
                                              const FeedSettings& settings) {
  RollingTime out;
  RollingFeed feed(model, settings);
  feed.begin(path.start.joints, path.start.branch, path.start.tool_length_mm);
  const auto take = [&] {
    while (feed.try_plan()) {
      for (const FeedPiece& piece : feed.window().committed) out.time_s += piece.duration;
    }
  };
  for (const JointSpan& span : path.spans) {
    if (!(span.band.length > 0)) continue;
    if (!feed.has_room()) take();
    if (is_fault(feed.push(span))) return out;
  }
  (void)feed.finish();
  take();
  out.count = feed.count();
  out.is_done = feed.is_done();
  return out;
}

/// What the optimum is allowed: all of the limits and no room for the override unless it says so.
struct OptimumTask {
  RateReserve reserve{0, 0};
  double cell_s = 0.002, rest_s = 0.004;  ///< CellSettings
  int max_passes = 12;                    ///< of linearisation
};

struct Optimum {
  double time_s = 0;          ///< 0: none was found
  double without_jerk_s = 0;  ///< no motion on these cells takes less
  int passes = 0;
};

/// Finds the optimum over one path.
class OptimumSearch {
 public:
  OptimumSearch(const MachineModel& model, const SpanPath& path, const OptimumTask& task)
      : task_(task), limits_(make_feed_limits(model, task.reserve)) {
    CellSettings settings;
    settings.cell_s = task.cell_s;
    settings.rest_s = task.rest_s;
    settings.feed_share = 1;
    settings.kept_cells = 1 << 16;
    grid_ = std::make_unique<CellGrid>(model, limits_, settings);
    grid_->begin(path.start.joints, path.start.tool_length_mm);
    for (const JointSpan& span : path.spans) {
      if (span.band.length > 0 && is_fault(grid_->push(span))) return;
    }
    is_ready_ = !is_fault(grid_->finish()) && grid_->is_complete();
  }

  [[nodiscard]] Optimum find() {
    Optimum out;
    if (!is_ready_) return out;
    set_ends();
    pass_without_jerk(out);
    JerkStep solver(*grid_, limits_, static_cast<int>(cells_));
    for (; out.passes < task_.max_passes; ++out.passes) {
      if (!solver.solve(problem())) {
        if (out.time_s > 0) break;
        lower_bar();
        continue;
      }
      const double time = time_of(solver), before = out.time_s;
      if (before == 0 || time < before) out.time_s = time;
      linearise_at(solver);
      if (before > 0 && time > before * (1 - kEnough)) break;
    }
    return out;
  }

 private:
  static constexpr double kEnough = 2e-5;     // gained by a pass, of the time
  static constexpr double kMin = 1e-6;        // of u̇² to linearise at, of the largest
  static constexpr double kLower = 0.3;       // where no plan is found at the bound
  static constexpr std::int64_t kReach = 12;  // cells beside a rest whose limits its speed keeps

  [[nodiscard]] double h(std::size_t k) const {
    return (*grid_)[1 + static_cast<std::int64_t>(k)].h;
  }

  /// The first and the last cell, and how many lie between.
  void set_ends() {
    const std::int64_t last = grid_->last(), reach = std::min(last, kReach);
    cells_ = static_cast<std::size_t>(last - 2);
    start_ = find_rest_cell(limits_, (*grid_)[0], true, steady_b(*grid_, limits_, 0, reach));
    stop_ = find_rest_cell(limits_, (*grid_)[last - 1], false,
                           steady_b(*grid_, limits_, last - reach, last));
  }

  void pass_without_jerk(Optimum& out) {
    std::vector<double> backward(cells_ + 2), bound(cells_ + 2);
    two_pass(*grid_, limits_, 1, start_.state.b, backward, bound);
    const double largest = *std::max_element(bound.begin(), bound.end());
    knots_.resize(cells_ + 1);
    middles_.resize(cells_);
    share_.resize(cells_ + 1);
    out.without_jerk_s = start_.duration + stop_.duration;
    for (std::size_t k = 0; k <= cells_; ++k) {
      knots_[k] = std::max(bound[k], kMin * largest);
      share_[k] = (*grid_)[1 + static_cast<std::int64_t>(k)].tight;
    }
    for (std::size_t k = 0; k < cells_; ++k) {
      middles_[k] = 0.5 * (knots_[k] + knots_[k + 1]);
      out.without_jerk_s += 2 * h(k) / (std::sqrt(bound[k]) + std::sqrt(bound[k + 1]));
    }
  }

  void lower_bar() {
    for (double& b : knots_) b *= kLower;
    for (double& b : middles_) b *= kLower;
  }

  /// With b' too: the room for the override is then asked for where the joints are, not where they
  /// may be.
  void linearise_at(const JerkStep& solver) {
    slopes_.resize(cells_ + 1);
    for (std::size_t k = 0; k <= cells_; ++k) {
      knots_[k] = solver.b(static_cast<int>(k));
      slopes_[k] = solver.slope(static_cast<int>(k));
    }
    for (std::size_t k = 0; k < cells_; ++k) middles_[k] = solver.middle(static_cast<int>(k));
  }

  [[nodiscard]] JerkProblem problem() const {
    JerkProblem out;
    out.first = 1;
    out.cells = static_cast<int>(cells_);
    out.begin = start_.state;
    out.end = {stop_.state.b, -stop_.state.slope};
    out.bar_knots = knots_.data();
    out.bar_middles = middles_.data();
    out.accel_share = out.jerk_share = share_.data();
    out.bar_slopes = slopes_.empty() ? nullptr : slopes_.data();
    return out;
  }

  /// By Simpson's rule on 1/√b, which is hardly off on such cells.
  [[nodiscard]] double time_of(const JerkStep& solver) const {
    double time = start_.duration + stop_.duration;
    for (std::size_t k = 0; k < cells_; ++k) {
      const int i = static_cast<int>(k);
      time += h(k) / 6 *
              (1 / std::sqrt(solver.b(i)) + 4 / std::sqrt(solver.middle(i)) +
               1 / std::sqrt(solver.b(i + 1)));
    }
    return time;
  }

  OptimumTask task_;
  FeedLimits limits_;
  std::unique_ptr<CellGrid> grid_;
  bool is_ready_ = false;
  std::size_t cells_ = 0;  ///< without the two at the rests
  RestCell start_, stop_;
  std::vector<double> knots_, middles_, share_, slopes_;
};

}  // namespace meridian::bench
