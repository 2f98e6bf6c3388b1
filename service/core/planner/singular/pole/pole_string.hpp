// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "service/core/planner/route/free_spline.hpp"
#include "service/core/planner/singular/pole/pole_travel.hpp"
#include "service/core/planner/singular/pole/pole_walls.hpp"
#include "service/core/planner/singular/pole/pole_zone.hpp"

namespace meridian {

/// Finds how the redundant joint goes along a stretch beside the pole: the string through its
/// corridor, smoothed, on the sides of the walls that turn it least of those that lead to a branch
/// and winding which carries farthest. Where the exact path takes less time, that.
///
/// The time is counted without regard to what lies around: the largest of |P'|/F, |q'|/V,
/// √(|q''|/A), ∛(|q'''|/J) over all joints. Every result is checked against tolerance and travel
/// where it lies. Fixed store, bounded work. Units: mm, rad, s. Source: docs/motion.md, section 10.
/// Proof: tests/property/planner/pole_string_test.cpp.
class PoleString {
 public:
  PoleString();

  /// The pieces of the stretch, one behind the other; none: the exact path has it. Valid until the
  /// next call.
  [[nodiscard]] std::span<const PoleZone> find(const PoleTask& task, const PolePass& pass) noexcept;
  /// Whether there were no pieces because the exact path is the best.
  [[nodiscard]] bool is_exact_best() const noexcept;

 private:
  static constexpr std::size_t kMaxLevels = 4;

  /// What a route behind the stretch has to carry.
  struct Ahead {
    bool keeps_travel = false;  ///< as far as it is known
    int blocks = 0;
  };

  /// All shapes along `course`; true where one of them is the best by now.
  void try_course(const PoleWalls::Course& course) noexcept;
  [[nodiscard]] bool leads_on(const PoleWalls::Course& course, const Ahead& ahead) const noexcept;
  [[nodiscard]] bool carries(int branch, const RouteAfter& route, int blocks) const noexcept;
  [[nodiscard]] bool has_exact(const Ahead& ahead) const noexcept;
  void find_best() noexcept;
  bool find_best(const Ahead& ahead) noexcept;
  [[nodiscard]] FreeEnd begin_of() const noexcept;
  [[nodiscard]] FreeEnd end_of(const PoleWalls::Course& course,
                               std::span<const StringWindow> windows) noexcept;
  [[nodiscard]] FreeEnd exact_end(double u, int branch, double near) const noexcept;
  [[nodiscard]] std::size_t node_count() const noexcept;

  void take_pieces(const PoleWalls::Course& course) noexcept;
  [[nodiscard]] double off_at(double u, double free) const noexcept;
  [[nodiscard]] bool is_within(const PoleZone& piece, double off) noexcept;
  [[nodiscard]] bool is_inside() noexcept;
  [[nodiscard]] bool is_inside_at_kinks() noexcept;
  /// Counted no farther than `most`.
  [[nodiscard]] double time_of_trial(double largest) const noexcept;
  [[nodiscard]] double exact_time() const noexcept;

  PoleWalls walls_;
  FreeSpline spline_;
  std::vector<PoleZone> best_, trial_;
  std::size_t best_count_ = 0, trial_count_ = 0;
  std::vector<double> values_;  ///< of a string over nodes
  double best_time_ = 0, deviation_rad_ = 0;
  const PoleTask* task_ = nullptr;
  const PolePass* pass_ = nullptr;
  int free_ = 0;
  int round_ = 0;            ///< of nearer walls
  bool is_any_off_ = false;  ///< some trial of the round left the tolerance
};

}  // namespace meridian
