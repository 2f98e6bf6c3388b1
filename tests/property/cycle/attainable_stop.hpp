// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "property/cycle/stop_cells.hpp"
#include "property/cycle/stop_motion.hpp"
#include "property/cycle/stop_oracle.hpp"
#include "service/core/planner/feed/cells/feed_rest.hpp"
#include "service/core/planner/feed/solver/jerk_step.hpp"

/// The fastest stop along a path that was found to keep every joint's limits on the path ahead.
namespace meridian::test {

/// Finds a stop from one state to rest, anywhere on the path, that keeps velocity, acceleration and
/// jerk of every joint to kWithin of them, by samples of its own motion.
///
/// Two methods, the faster of what they find counts:
/// 1. The greediest stop (stop_oracle.hpp), with less and less of the limits until its motion keeps
///    all of them: where limits do not tighten ahead, with all of them, and that is the optimum.
/// 2. The feed's convex programme (JerkStep) over cells ahead, to rest at a given length, about the
///    motion of the first, then with the rest nearer and nearer until there is no such motion.
///
/// It promises a stop that a machine could make, not that none is faster: the greediest stop with
/// all of the limits shows how near it is. `Path` gives joints in jets at path lengths that grow,
/// and by end() where the path piece ends that it was asked for last; it is copied.
template <class Path>
class AttainableStop {
 public:
  static constexpr double kWithin = 1.01;

  AttainableStop(const MachineModel& machine, const PathState& begin, const Path& path)
      : machine_(machine),
        begin_(begin),
        path_(path),
        limits_(joint_limits(machine)),
        cells_(machine, limits_),
        solver_(cells_.grid(), limits_, kCells) {}

  [[nodiscard]] std::optional<StopMotion> find() {
    const GreedyWalk walk{1, kStep_s, kLongest_s};
    const double coarse_s =
        walk_greedily(machine_, begin_, Path(path_), walk, [](const PathState&) {}).time_s;
    if (coarse_s >= kLongest_s) return best_;
    step_s_ = std::min(kStep_s, coarse_s / kSteps);
    const StopMotion greediest = greedy(1);
    if (take(greediest)) return best_;
    double share = 1;
    while (!best_ && share > kNone) take(greedy(share *= kLess));
    if (share < kNearly) lengthen(greediest);
    if (best_) shorten();
    return best_;
  }

  /// The greediest stop with a share of the limits.
  [[nodiscard]] StopMotion greedy(double share) const {
    StopMotion out;
    const auto visit = [&](const PathState& p) { out.add(p.s - begin_.s, p.ds * p.ds, 2 * p.dds); };
    const GreedyWalk walk{share, step_s_, kLongest_s};
    out.land(walk_greedily(machine_, begin_, Path(path_), walk, visit).distance_mm);
    return out;
  }

  /// The fastest with its rest at `length`, linearised about `known` and then about itself.
  [[nodiscard]] std::optional<StopMotion> solve(double length, const StopMotion& known) {
    constexpr int kPasses = 3;
    constexpr double kEnough = 3e-3;  // gained by a pass, of the time
    cells_.make(begin_.s, length, path_);
    std::optional<StopMotion> fastest;
    for (int pass = 0; pass < kPasses; ++pass) {
      const auto found = solve_about(length, fastest ? *fastest : known);
      if (!found) break;
      const double before_s = fastest ? fastest->time_s() : 1e9;
      if (found->time_s() < before_s) fastest = found;
      if (found->time_s() > before_s * (1 - kEnough)) break;
    }
    return fastest;
  }

  /// What the joints do on `motion`.
  [[nodiscard]] StopUse use(const StopMotion& motion) const {
    return use_of(limits_, motion, begin_.s, path_);
  }

 private:
  static constexpr int kCells = StopCells::kCells - 1;   // without that in which it lands
  static constexpr double kStep_s = 1e-4, kSteps = 400;  // of the greediest stop, at least
  static constexpr double kLongest_s = 0.7;              // it is stuck where it takes longer
  static constexpr double kLess = 0.985, kNearly = 0.95, kNone = 0.5;  // shares of the limits

  /// Whether `motion` keeps all limits and ends before the path does.
  [[nodiscard]] bool is_kept(const StopMotion& motion) const {
    constexpr double kRounding_mm = 1e-9;
    Path path = path_;
    const double rest = begin_.s + motion.length();
    (void)path(rest);
    return path.end() >= rest - kRounding_mm && use(motion).max() <= kWithin;
  }

  /// Whether `motion` is the best so far, which it is then.
  bool take(const std::optional<StopMotion>& motion) {
    const bool is_best = motion && (!best_ || motion->time_s() < best_->time_s());
    if (!is_best || !is_kept(*motion)) return false;
    best_ = motion;
    return true;
  }

  /// Puts the rest farther off than that of `greediest` until there is a motion to it.
  void lengthen(const StopMotion& greediest) {
    for (const double farther : {1.01, 1.04, 1.1, 1.2, 1.5}) {
      if (take(solve(farther * greediest.length(), greediest))) return;
    }
  }

  /// Brings the rest nearer as long as there is a motion to it that takes less time.
  void shorten() {
    for (const double nearer : {0.94, 0.98, 0.995}) {
      while (take(solve(nearer * best_->length(), *best_))) continue;
    }
  }

  [[nodiscard]] std::optional<StopMotion> solve_about(double length, const StopMotion& known) {
    constexpr double kTiny = 1e-7;  // of b to linearise at, of that at the begin
    const std::vector<double>& s = cells_.knots();
    const double stretch = known.length() / length, b = begin_.ds * begin_.ds;
    const auto bar = [&](double at) { return std::max(kTiny * b, known.b_at(at * stretch)); };
    std::vector<double> knots, middles;
    for (std::size_t k = 0; k <= kCells; ++k) knots.push_back(bar(s[k]));
    for (std::size_t k = 0; k < kCells; ++k) middles.push_back(bar(0.5 * (s[k] + s[k + 1])));
    const std::vector<double> share(kCells + 1, 1.0);
    const RestCell rest = landing();
    JerkProblem problem;
    problem.cells = kCells;
    problem.begin = {b, 2 * begin_.dds};
    problem.end = {rest.state.b, -rest.state.slope};
    problem.bar_knots = knots.data();
    problem.bar_middles = middles.data();
    problem.accel_share = problem.jerk_share = share.data();
    if (!solver_.solve(problem)) return std::nullopt;
    StopMotion out;
    for (int k = 0; k <= kCells; ++k) {
      out.add(s[static_cast<std::size_t>(k)], solver_.b(k), solver_.slope(k));
    }
    out.land(length);
    return out;
  }

  /// The fastest landing in the last cell.
  [[nodiscard]] RestCell landing() const {
    constexpr double kAll = 1 / 0.92, kFree = 1e12;  // find_rest_cell() leaves some of the limits
    return find_rest_cell(limits_.scaled(kAll, kAll, kAll), cells_.grid()[kCells], false, kFree);
  }

  const MachineModel& machine_;
  PathState begin_;
  Path path_;
  FeedLimits limits_;
  StopCells cells_;
  JerkStep solver_;
  double step_s_ = kStep_s;  ///< of the greediest stop
  std::optional<StopMotion> best_;
};

}  // namespace meridian::test
