// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "meridian/geometry/vector3.hpp"
#include "meridian/path/band_spline.hpp"
#include "meridian/path/cl_block.hpp"
#include "meridian/path/path_piece.hpp"
#include "service/core/path/index_ring.hpp"

namespace meridian {

/// Tip (mm) and axis in one vector.
using Vector6 = std::array<double, 6>;

/// Vertices that the polyline holds, and those that a knot may look ahead over: the longest gap
/// between knots shrinks where blocks are so short that more would be needed (docs/motion.md, 1.2).
inline constexpr std::int64_t kVertexCapacity = 65536;
inline constexpr std::int64_t kVertexReach = 2048;

/// Blocks whose end is nearer than this to the vertex before count as no route at all.
inline constexpr double kMinStep_mm = 1e-6;

/// Within this of u before and after a point in inverse time blocks say how fast tip and axis may
/// be there: as far as a corner is felt at the widest gaps (docs/motion.md, 1.5).
inline constexpr double kSpeedReach_mm = 5;

/// Of the axis tolerance beside the pole of a machine that relaxes the axis, and on it: within
/// kOnPole_tolerances. The rest is left to the axis deviation, which needs little on the pole.
inline constexpr double kBesidePoleShare = 0.5;
inline constexpr double kOnPoleShare = 0.9;
inline constexpr double kOnPole_tolerances = 0.95;

/// Where a segment lies, of a machine that relaxes the axis.
enum class PoleSide : std::uint32_t { kFar, kBeside, kOn };

/// One corner of the CL polyline with the segment that ends in it. The store is most of a planner's
/// memory: what follows from little is not kept.
// Flags: of one segment, packed into the word of the counts; each combination occurs.
struct BandVertex {
  Vector6 x{};            ///< tip, axis
  double u = 0;           ///< chord length from the begin
  double tip_turns = 0;   ///< sum of the jumps of dP/du at the vertices before this one
  double axis_turns = 0;  ///< the same of dK/du
  double gap = 0;         ///< largest gap between knots here; final only behind BandKnots' front
  double feed_mm_per_s = std::numeric_limits<double>::infinity();
  double u_speed_mm_per_s = std::numeric_limits<double>::infinity();
  double block_feed_mm_per_s = 0;
  double asked_mm_per_s = 0;   ///< tip speed that the block asks for
  double asked_rad_per_s = 0;  ///< the same of the axis
  std::uint64_t sequence = 0;
  std::uint32_t line = 0;
  std::uint32_t beside_pole : 14 = 0;  ///< segments beside the pole up to the one that ends here
  std::uint32_t on_pole : 13 = 0;      ///< and on it, both modulo more than a knot depends on
  PoleSide side : 2 = PoleSide::kFar;  ///< the segment's
  bool is_short_in_time : 1 = false;  ///< of a block in inverse time, no longer than tolerances are
  bool is_of_arc : 1 = false;         ///< the segment is a chord
  bool ends_block : 1 = false;
};

/// The CL polyline in u, du² = |dP|² + (50 mm/rad · |dK|)²: blocks cut into segments that are
/// straight in tip and axis, as far as the ring has room.
class BandPolyline {
 public:
  BandPolyline();

  void begin(const ToolPose& pose, const BandTolerance& tolerance) noexcept;

  /// Whether a block can be taken: the one before has been cut to its end.
  [[nodiscard]] bool is_ready() const noexcept { return !piece_; }
  /// Takes `block` and cuts it as far as there is room.
  void take(const ClBlock& block) noexcept;
  /// Cuts on. Returns whether the block in work is done.
  bool cut() noexcept;
  /// No more blocks.
  void finish() noexcept { is_finished_ = true; }
  /// Whether the last vertex is the last of the path.
  [[nodiscard]] bool is_complete() const noexcept { return is_finished_ && is_ready(); }

  [[nodiscard]] const BandTolerance& tolerance() const noexcept { return tolerance_; }
  /// Of the tolerances, what the spline may use on the segment that ends in `vertex`.
  [[nodiscard]] static double share_of(const BandVertex& vertex) noexcept;
  /// Of the axis on that segment, rad.
  [[nodiscard]] double axis_tolerance_of(const BandVertex& vertex) const noexcept {
    return axis_share_of(vertex.side) * tolerance_.axis_rad;
  }
  /// The least of the segments behind vertex `before` as far as vertex `to`, rad; no more of them
  /// than a knot depends on.
  [[nodiscard]] double axis_tolerance_between(const BandVertex& before,
                                              const BandVertex& to) const noexcept;
  [[nodiscard]] const BandVertex& operator[](std::int64_t i) const noexcept { return ring_[i]; }
  [[nodiscard]] BandVertex& operator[](std::int64_t i) noexcept { return ring_[i]; }
  [[nodiscard]] std::int64_t first() const noexcept { return ring_.begin_index(); }
  [[nodiscard]] std::int64_t last() const noexcept { return ring_.end_index() - 1; }
  void drop_before(std::int64_t i) noexcept { ring_.drop_before(i); }

  /// Index of the first vertex in [low, last() + 1] with a larger u (upper bound).
  [[nodiscard]] std::int64_t find_after(double u, std::int64_t low) const noexcept;
  /// Index of the first vertex in [low, last() + 1] with u no smaller (lower bound).
  [[nodiscard]] std::int64_t find_from(double u, std::int64_t low) const noexcept;
  /// Begin of the segment that holds `u`, not before `low`; the last one where u is its end.
  [[nodiscard]] std::int64_t segment_at(double u, std::int64_t low) const noexcept;
  /// The point of segment `i` at `u`.
  [[nodiscard]] Vector6 at(double u, std::int64_t i) const noexcept;

 private:
  template <class Is>
  [[nodiscard]] std::int64_t find_first(std::int64_t low, Is is_it) const noexcept;
  void take_feed(const ClBlock& block) noexcept;
  void add(const ToolPose& pose, bool ends_block) noexcept;
  [[nodiscard]] PoleSide find_side(const Vector6& from, const Vector6& to) const noexcept;
  [[nodiscard]] static double axis_share_of(PoleSide side) noexcept;

  IndexRing<BandVertex> ring_;
  BandTolerance tolerance_;
  double largest_turn_ = 0;  ///< of the axis on one segment, rad
  bool is_finished_ = false;
  ToolPose pose_;                   ///< end of what was taken
  std::optional<PathPiece> piece_;  ///< block in work
  ToolPose end_;                    ///< its end
  std::int64_t steps_ = 0, step_ = 0;
  BandVertex pattern_;  ///< what all vertices of the block in work share
};

}  // namespace meridian
