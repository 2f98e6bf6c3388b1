// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "service/core/planner/singular/pole/pole_zone.hpp"
#include "service/core/planner/singular/pole/taut_string.hpp"

namespace meridian {

/// The corridor of the redundant joint along a stretch beside the pole, at places so close that it
/// moves little from one to the next.
///
///     gate ─ wall ─ gate ─ wall ─┬ side k     walls: the redundant joint is within `half` of the
///     exact
///                                └ side k+1   one, on either branch and winding; gates: anywhere
///
/// With p the smoothed axis and p' the programmed one, both seen along the pole, the axis that the
/// redundant joint gives lies on the circle over the pole and p. What of the circle is within the
/// tolerance of p' is the corridor. Fixed store. Units: mm, rad, s. Source: docs/motion.md,
/// section 10.
class PoleWalls {
 public:
  static constexpr std::size_t kNodes = 4096;

  /// One place of the corridor.
  struct Node {
    double u = 0;
    double t = 0;                    ///< at the programmed feed
    std::array<double, 2> middle{};  ///< of the corridor on either branch, in a wall
    double half = 0;                 ///< its half width
    bool is_wall = false;
    bool is_pinned = false;  ///< the exact path begins or ends here
  };
  /// What the sides of all walls cost, and which way on the last of them leads.
  struct Course {
    double value = 0;  ///< of the redundant joint behind its wall, turned no farther than it has to
    double turned = 0;  ///< the way there
    int side = 0;       ///< twice the whole turns, and the branch
    std::int32_t before = -1;
  };

  PoleWalls();

  /// Forgets where walls are nearer than the tolerance asks for.
  void loosen() noexcept { tight_count_ = 0; }
  /// Walls from `begin` to `end` of the path are nearer when they are looked at next; once in a
  /// `round`, however often it is said. False: at too many places.
  bool tighten(double begin, double end, int round) noexcept;

  /// Looks along the stretch, as far as it is known. False: too long or too sharp to be followed.
  [[nodiscard]] bool look(const PoleTask& task, const PolePass& pass) noexcept;

  /// Finds the routes past all walls, of those that lead to the same side of the last the shortest;
  /// the shortest first. `value`: the redundant joint at the begin.
  [[nodiscard]] std::span<const Course> find_courses(double value) noexcept;

  /// What the redundant joint may be at every node on the way `course`: a string's windows.
  [[nodiscard]] std::span<const StringWindow> windows_of(const Course& course) noexcept;

  [[nodiscard]] std::span<const Node> nodes() const noexcept { return {nodes_.data(), count_}; }
  /// The exact redundant joint of a node on a side.
  [[nodiscard]] static double middle_of(const Node& node, int side) noexcept;

 private:
  static constexpr std::size_t kRuns = 512;
  static constexpr std::size_t kCourses = 8 * kRuns;

  /// Nodes [first, last) of one wall, and the routes that lead past it.
  struct Run {
    std::size_t first = 0, last = 0;
    std::int32_t begin = 0, end = 0;
  };
  /// Where walls are nearer: by a share of the tolerance.
  struct Tight {
    double begin = 0, end = 0;
    double share = 1;
    int round = 0;
  };
  [[nodiscard]] double share_at(double u) const noexcept;
  /// What is kept from one node to the next.
  struct Seen;

  [[nodiscard]] bool see(double u, const Seen& before, Seen& out) const noexcept;
  [[nodiscard]] bool add(const Seen& seen) noexcept;
  [[nodiscard]] bool find_runs() noexcept;
  [[nodiscard]] bool walk(const Run& run, int side, Course& course) const noexcept;
  [[nodiscard]] bool pass(Run& run, std::span<const Course> from, std::int32_t base,
                          int spread) noexcept;
  void prune(Run& run, bool is_last) noexcept;

  const PoleTask* task_ = nullptr;
  int free_ = 0;
  double low_ = 0, high_ = 0;  ///< travel of the redundant joint
  double turn_sign_ = 1;       ///< of the redundant joint with the azimuth
  Vector3 pole_ = Vector3::UnitZ(), across_ = Vector3::UnitX(), along_ = Vector3::UnitY();
  std::vector<Node> nodes_;
  std::size_t count_ = 0;
  std::vector<Run> runs_;
  std::size_t run_count_ = 0;
  std::vector<Course> courses_;
  std::int32_t course_count_ = 0;
  std::vector<StringWindow> windows_;
  std::array<Tight, 256> tight_;
  std::size_t tight_count_ = 0;
};

}  // namespace meridian
