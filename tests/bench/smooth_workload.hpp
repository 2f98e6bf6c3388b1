// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/cl_block.hpp"
#include "meridian/planner/motion_port.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "property/path/hostile_path.hpp"
#include "service/core/planner/feed/rolling/feed_raise.hpp"
#include "service/core/planner/look_ahead/smooth_run.hpp"
#include "support/cpu_time.hpp"
#include "support/dense_block.hpp"
#include "support/machines.hpp"

/// Smooth runs window by window: what each costs beside the motion that it yields.
namespace meridian::bench {

using test::cpu_s;
using test::dense_block;

/// What came to pass between a window and the one before it: blocks taken, spline, plan, authority.
struct WindowCost {
  double cpu_s = 0;     ///< CPU time of all that
  double motion_s = 0;  ///< of the window without its tail
  int blocks = 0;       ///< taken since the window before
  [[nodiscard]] double share() const noexcept { return cpu_s / motion_s; }
};

/// What a run came to.
struct SmoothTotal {
  std::vector<WindowCost> windows;
  std::uint64_t checksum = 14695981039346656037ULL;  ///< of every published piece
  bool has_failed = false;

  /// The same run again: of every window the lesser cost stays, which other work on the host spoils
  /// less.
  void keep_min(const SmoothTotal& again) {
    has_failed |= again.has_failed || again.checksum != checksum;
    for (std::size_t n = 0; n < std::min(windows.size(), again.windows.size()); ++n) {
      windows[n].cpu_s = std::min(windows[n].cpu_s, again.windows[n].cpu_s);
    }
  }
};

/// Joints of a block on the first branch that reaches it, and that branch.
[[nodiscard]] inline RunStart start_at(const MachineModel& model, const ClBlock& block) {
  RunStart start;
  start.pose = start.programmed = {to_vector(block.tip_mm), to_vector(block.axis).normalized()};
  start.tool_length_mm = model.tool_length_mm;
  for (int branch = branch_count(model); branch-- > 0;) {
    const auto at = solve(model, model.tool_length_mm, start.pose, branch, JointVector{});
    if (at.status == SolveStatus::kUnreachable || first_joint_outside_travel(model, at.q, 0) >= 0) {
      continue;
    }
    start.joints = at.q;
    start.branch = branch;
  }
  return start;
}

/// Runs cuts smoothly, from rest at the first to rest at the last, in the machine's tolerances; a
/// cycle that needs no time reads every window as it is published.
class SmoothWindows {
 public:
  explicit SmoothWindows(const MachineModel& model)
      : model_(model), raise_(model_), run_(model_, raise_), writer_(port_) {}

  /// Ends early once `total` has `max_windows`.
  void run(const std::vector<ClBlock>& blocks, SmoothTotal& total,
           std::size_t max_windows = std::numeric_limits<std::size_t>::max()) {
    RunStart start = start_at(model_, blocks.front());
    start.epoch = ++epoch_;
    start.is_on_pole = std::all_of(blocks.begin(), blocks.end(), [this](const ClBlock& block) {
      return redundant_joint(model_) >= 0 &&
             pole_distance(model_, to_vector(block.axis)) < kPoleDeviation_rad;
    });
    BandTolerance tolerance;
    tolerance.tip_mm = model_.tolerances.tip_mm;
    tolerance.axis_rad = model_.tolerances.axis_rad;
    const bool relaxed_axes =
        redundant_joint(model_) >= 0 && model_.pole_policy == PolePolicy::kRelax;
    if (relaxed_axes) tolerance.pole = to_array(pole_direction(model_));
    run_.begin(start, tolerance,
               std::max(model_.tolerances.axis_rad, model_.tolerances.pole_axis_rad));
    max_windows_ = max_windows;
    cost_ = {};
    begin_s_ = cpu_s();
    for (std::size_t n = 1; n < blocks.size() && total.windows.size() < max_windows; ++n) {
      run_.take(blocks[n]);
      ++cost_.blocks;
      publish(total);
    }
    run_.finish();
    publish(total);
  }

 private:
  void publish(SmoothTotal& total) {
    using Status = SmoothRun::Status;
    Status status = Status::kPublished;
    for (int tries = 0; tries < 100 && total.windows.size() < max_windows_;) {
      status = run_.publish_window(writer_);
      if (status == Status::kNeedsBlocks || status == Status::kDone) return;
      if (status == Status::kFailed) {
        total.has_failed = true;
        return;
      }
      tries = status == Status::kPublished ? 0 : tries + 1;
      read(total);
    }
  }

  /// Takes what was published off the port and informs the planner that its window was begun.
  void read(SmoothTotal& total) {
    cost_.cpu_s += cpu_s() - begin_s_;
    bool has_piece = false;
    while (const TimePiece* piece = port_.times.peek(0)) {
      if (!piece->is_tail) cost_.motion_s += piece->duration;
      for (const double x : {piece->duration, piece->v, piece->a, piece->j, piece->k,
                             piece->stop_accel, piece->slow_fault_jerk}) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &x, sizeof bits);
        total.checksum = (total.checksum ^ bits) * 1099511628211ULL;
      }
      port_.window_begun.store((std::uint64_t{1} << 63U) | (std::uint64_t{epoch_} << 32U) |
                               piece->window);
      port_.times.drop(1);
      has_piece = true;
    }
    port_.paths.drop(port_.paths.size());
    if (has_piece) {
      total.windows.push_back(cost_);
      cost_ = {};
    }
    begin_s_ = cpu_s();
  }

  MachineModel model_;
  FeedRaise raise_;
  SmoothRun run_;
  MotionPort port_;
  MotionWriter writer_;
  WindowCost cost_;
  double begin_s_ = 0;  ///< CPU time at which what cost_ has not counted yet began
  std::uint16_t epoch_ = 0;
  std::size_t max_windows_ = 0;
};

[[nodiscard]] inline std::vector<ClBlock> dense_blocks(int count, double step, double feed) {
  std::vector<ClBlock> blocks;
  blocks.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    blocks.push_back(dense_block(static_cast<std::uint64_t>(i), step, feed));
  }
  return blocks;
}

/// A checksum of `n` windows of programs that are meant to hurt the planner; 0 if one failed.
[[nodiscard]] inline std::uint64_t run_smooth_hostile(int n) {
  const auto windows = std::make_unique<SmoothWindows>(test::bench_machine());
  SmoothTotal total;
  for (std::uint32_t seed = 1; total.windows.size() < static_cast<std::size_t>(n); ++seed) {
    windows->run(test::HostilePath(seed).make(8), total, static_cast<std::size_t>(n));
    if (total.has_failed) return 0;
  }
  return total.checksum;
}

/// A checksum of what `n` blocks of `step` mm at 50 mm/s become; 0 if one failed.
[[nodiscard]] inline std::uint64_t run_smooth_blocks(int n, double step) {
  const auto windows = std::make_unique<SmoothWindows>(test::bench_machine());
  SmoothTotal total;
  windows->run(dense_blocks(n, step, 50), total);
  return total.has_failed ? 0 : total.checksum;
}

}  // namespace meridian::bench
