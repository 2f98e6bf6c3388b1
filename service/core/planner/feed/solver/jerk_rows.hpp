// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>

#include "service/core/planner/feed/cells/feed_cells.hpp"

/// The rows of the feed's convex programme, those left out that others imply. Units: mm, rad, s.
/// Source: docs/motion.md, section 8.
namespace meridian {

/// Of the three coefficients of b = u̇² that a cell sees.
using JerkCoefficients = std::array<double, 3>;

/// a·c <= limit
struct JerkRow {
  JerkCoefficients a{};
  double limit = 0;
};

/// What is known of a cell before its programme is solved. Places: begin, middle, end.
struct JerkCell {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  static constexpr std::array<double, 3> kNone{kUnknown, kUnknown, kUnknown};
  const FeedCell* cell = nullptr;
  bool is_first = false;                    ///< its begin is given: nothing binds there
  JerkCoefficients b{}, slope{}, end{};     ///< b and b' at the begin, b' at the end
  JerkCoefficients middle{};                ///< b in the middle
  std::array<double, 3> bar{};              ///< b around which jerk is linearised
  std::array<double, 3> bar_slope = kNone;  ///< b' there; NaN: not known
  std::array<double, 3> max_b{};            ///< that other rows allow, or what is given
  double accel_share = 1, jerk_share = 1;   ///< of A at the begin, of J
  double max_slope = 0, max_end = 0;        ///< largest |b'| at begin and end
  int slope_joint = -1;                     ///< by the acceleration of which joint, -1: given
};

/// Largest |b'| that the acceleration rows leave at the begin of `at`, and by which joint.
void bound_slope(const FeedLimits& limits, JerkCell& at) noexcept;

/// Rows of a cell that may bind. Those of a joint are left out where b, b' and b'' can nowhere be
/// so large that they would: b' is bounded by the acceleration of one joint, b'' by the jerk of
/// one, whose rows stay.
class JerkRows {
 public:
  static constexpr int kMax = 8 * static_cast<int>(kMaxLimited) + 2;

  void find(const FeedLimits& limits, const JerkCell& at) noexcept;
  [[nodiscard]] int count() const noexcept { return count_; }
  [[nodiscard]] const JerkRow& operator[](int row) const noexcept {
    return rows_[static_cast<std::size_t>(row)];
  }

 private:
  /// b, b' and b'' at a place as combinations of the coefficients, and their largest values.
  struct RowSample {
    JerkCoefficients b{}, slope{}, bend{};
    double max_b = 0, max_slope = 0, bar = 0, bar_slope = 0;
    const CellSample* at = nullptr;
  };
  /// |q''' b + 3/2 q'' b' + 1/2 q' b''| + per_accel (q' b'/2 + q'' b) + per_b b <= limit
  struct JerkLine {
    double per_accel = 0, per_b = 0, limit = 0;
  };
  [[nodiscard]] static JerkLine line_at(const FeedLimits& limits, const RateRoom& room,
                                        const RowSample& sample, int joint, double share) noexcept;
  [[nodiscard]] static double rest_of(const JerkLine& line, const RowSample& sample,
                                      int joint) noexcept;
  void add(const JerkCoefficients& a, double limit) noexcept;
  /// |value| + rest <= limit
  void add_pair(const JerkCoefficients& value, const JerkCoefficients& rest, double limit) noexcept;
  void add_acceleration(const FeedLimits& limits, const JerkCell& at) noexcept;
  void add_jerk(const FeedLimits& limits, const JerkCell& at) noexcept;

  std::array<JerkRow, kMax> rows_;
  int count_ = 0;
};

}  // namespace meridian
