// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "meridian/geometry/vector3.hpp"
#include "meridian/path/band_span.hpp"
#include "meridian/path/cl_block.hpp"

namespace meridian {

/// How far the smooth path may leave the programmed one, tip and axis together at every point.
struct BandTolerance {
  double tip_mm = 0.01;        ///< >= 0.001
  double axis_rad = 1.745e-3;  ///< >= 1e-4, against the great circle between block axes
  /// Direction of the pole in W, where the machine has one that relaxes the axis: within 0.02 rad
  /// of it, or of its opposite, the band keeps to half of `axis_rad`, on it to 0.9, and leaves the
  /// rest to the axis deviation.
  std::optional<Array3> pole;
};

/// Numbers of the method. The defaults are measured (docs/motion.md); tests set others.
struct BandTuning {
  int window = 96;        ///< control points that a window moves
  int commit = 48;        ///< of which so many are then final
  int iterations = 25;    ///< at most
  double settled = 0.01;  ///< tolerances: an iteration that moves nothing farther is the last
  double smoothness = 3;  ///< weight of the third difference
  double relaxation = 1.6;
  double radius = 0.92;  ///< of the band at the samples, in tolerances
  /// Bound the mean spline too, for BandStatistics::largest_mean. Nothing rests on it: where a
  /// window is put back on the mean spline, what comes of it is verified as any other.
  bool bounds_mean = false;
};

/// The programmed pose at a point: between two of them the tip is on the straight line, the axis on
/// their great circle.
struct AxisMark {
  double u = 0;
  Array3 tip{};
  Array3 axis{};  ///< unit
};

/// What the spline did since its construction.
struct BandStatistics {
  std::uint64_t windows = 0;
  std::uint64_t pulled_windows = 0;  ///< where a span had to be pulled back
  std::uint64_t reset_windows = 0;   ///< pulled back as a whole
  std::uint64_t control_points = 0;
  double largest_mean = 0;  ///< of the mean spline, in tolerances; see BandTuning::bounds_mean
  double largest = 0;       ///< bound of the committed spline's deviation, in tolerances
};

/// The smooth path through a stream of CL blocks: a quartic spline of tip and tool axis with three
/// continuous derivatives that never leaves the tolerance band about the CL polyline.
///
///     begin(pose) ─ push(block) ... push(block) ─ finish()
///                        └── next() ... next() ──────┘       until it returns nullptr
///
/// Every span is verified in closed form before it is handed out, between the block ends too. What
/// comes out depends on the blocks alone, bit for bit, not on when they came or when next() was
/// called. The committed spline ends at most 172 mm of u after the last block, until
/// finish() clamps its end to the last block's pose: a program that goes on smoothly calls it at
/// rests alone. Memory is bounded and allocated at construction; blocks may be as short as they
/// like. Arcs are followed by chords that use 2 % of the tip tolerance.
///
/// Method and formulas: docs/motion.md, section 1. Context: planner thread; no clock, no lock.
/// Proof: tests/property/path.
class BandSpline {
 public:
  explicit BandSpline(const BandTuning& tuning = {});
  ~BandSpline();
  BandSpline(const BandSpline&) = delete;
  BandSpline& operator=(const BandSpline&) = delete;

  /// Forgets everything and starts at rest at `pose`, u = 0.
  void begin(const ToolPose& pose, const BandTolerance& tolerance) noexcept;

  /// Takes a kCut block whose axis is not opposite to the one before. False: no room, call next()
  /// until it returns nullptr and push again; then there is room.
  [[nodiscard]] bool push(const ClBlock& block) noexcept;

  /// No more blocks: the spline ends on the last one.
  void finish() noexcept;

  /// Returns the next committed span, nullptr where more blocks or finish() are needed, or after
  /// the last one. Valid until the next call of any function but next_block_end(). A call that has
  /// none left smooths a window first.
  [[nodiscard]] const BandSpan* next() noexcept;

  /// The ends of blocks on the span that next() returned last, one per call, in order.
  [[nodiscard]] std::optional<BlockEnd> next_block_end() noexcept;

  /// The block that goes on behind that span, once next_block_end() has returned nullopt; `u` is a
  /// point on it. nullopt: no block does.
  [[nodiscard]] std::optional<BlockEnd> block_behind() const noexcept;

  /// The next corner of the programmed axis, in order and ahead of the spans; nullopt: no more yet.
  /// To be called until then after every push() and next(); corners that were not asked for are
  /// lost.
  [[nodiscard]] std::optional<AxisMark> next_axis() noexcept;

  /// Whether finish() was called and the last span was handed out.
  [[nodiscard]] bool is_done() const noexcept;

  /// Whether a span could not be verified. Nothing of it or behind it is handed out. The bounds of
  /// docs/motion.md leave a third of the tolerance between this and anything that was ever seen.
  [[nodiscard]] bool has_failed() const noexcept;

  [[nodiscard]] const BandStatistics& statistics() const noexcept;

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace meridian
