// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "meridian/path/band_spline.hpp"
#include "service/core/path/index_ring.hpp"
#include "service/core/planner/feed/cells/joint_span.hpp"
#include "service/core/planner/singular/robot/robot_pass.hpp"

namespace meridian {

/// From spans of the path to spans that the joints of a robot follow. Where the tool comes into
/// line with the forearm within the axis tolerance, the roll is driven from one side to the other
/// and the bend runs through zero; where the wrist point comes over the base axis within the tip
/// tolerance, the yaw is driven and the arm goes over (RobotPass).
///
///     push(span) ... finish() ─▶ next() ... next() until it returns nullptr
///
/// Spans beside a singular place are held back by up to kPassReach_mm of u until it is known how
/// close they come. What comes out depends on the spans alone. Other machines get their spans as
/// they are. Fixed store. Units: mm, rad. Context: planner thread. Source: docs/motion.md, section
/// 2. Proof: tests/property/planner/robot_passes_test.cpp.
class RobotPasses : private SpanLookup {
 public:
  explicit RobotPasses(const MachineModel& model);

  struct Start {
    JointVector joints{};
    int branch = 0;
    double tool_length_mm = 0;
    ToolPose pose{Vector3::Zero(), Vector3::UnitZ()};     ///< programmed there
    double axis_tolerance_rad = 0, tip_tolerance_mm = 0;  ///< smoothing included
  };
  void begin(const Start& start) noexcept;

  /// What is programmed there, in order. Ahead of spans.
  void mark(const AxisMark& mark) noexcept {
    if (!is_used_) return;
    axes_.add(mark.u, to_vector(mark.axis));
    tips_.add(mark.u, to_vector(mark.tip));
  }

  /// Takes the next span. Only after next() returned nullptr.
  void push(const JointSpan& span) noexcept;
  /// No more spans.
  void finish() noexcept { is_finished_ = true; }
  /// Returns the next span, nullptr where more are needed; valid until the next call.
  [[nodiscard]] const JointSpan* next() noexcept;

 private:
  static constexpr std::size_t kSpans = 1024;
  static constexpr std::int64_t kProbes = 8;  ///< per span

  struct Held {
    JointSpan span;
    /// To each singular place, from the span's begin on.
    std::array<std::array<double, kProbes>, kSingularities> distance{};
  };
  void measure(Held& held) const noexcept;
  [[nodiscard]] const BandSpan& span_at(double u) const noexcept override;
  [[nodiscard]] double u_of(std::int64_t probe) const noexcept;
  [[nodiscard]] double distance_of(Singularity at, std::int64_t probe) const noexcept;
  [[nodiscard]] double distance_at(Singularity at, double u) const noexcept;
  [[nodiscard]] double tolerance(Singularity at) const noexcept {
    return at == Singularity::kWrist ? axis_tolerance_rad_ : tip_tolerance_mm_;
  }
  [[nodiscard]] std::int64_t end_probe() const noexcept { return kProbes * spans_.end_index(); }
  [[nodiscard]] double end_u() const noexcept;
  [[nodiscard]] double emitted_u() const noexcept;

  /// Decides about minima of the distance as far as enough of what follows is there.
  void scan() noexcept;
  /// Takes a pass about `nearest`, if there is one; false: not enough of what follows is there.
  [[nodiscard]] bool settle(Singularity at, double nearest) noexcept;
  [[nodiscard]] PassTask task() const noexcept;
  /// Whether a pass is to begin where the last one ends: joints rest there, or both singularities
  /// are so near that rounding would turn the roll of the exact path.
  [[nodiscard]] bool goes_on() const noexcept;
  /// To which of them the path is nearer at `u` than `share` of the tolerance.
  [[nodiscard]] SingularSet singular_at(double u, double share) const noexcept;
  [[nodiscard]] bool is_minimum(Singularity at, std::int64_t probe) const noexcept;
  [[nodiscard]] double refine_minimum(Singularity at, std::int64_t probe) const noexcept;
  [[nodiscard]] bool is_out_of_reach(const Held& held) const noexcept;
  [[nodiscard]] JointVector follow_to(double u) const noexcept;
  [[nodiscard]] bool may_emit() const noexcept;
  void emit() noexcept;

  const MachineModel& model_;
  // Flags: the machine's, the input's and the output's: none excludes another.
  bool is_used_ = false, is_finished_ = false, is_exact_ = false;
  double tool_length_mm_ = 0, axis_tolerance_rad_ = 0, tip_tolerance_mm_ = 0;
  ProgrammedAxis axes_;
  ProgrammedTip tips_;
  IndexRing<Held> spans_;
  std::int64_t probe_ = 0;  ///< next to decide about
  double emitted_x_ = 0;    ///< of the first span held
  JointVector known_{};     ///< joints at emitted_u()
  int branch_ = 0;          ///< where spans are handed out
  bool has_pass_ = false;
  SingularSet held_ = SingularSet::kNone;  ///< whose joints rest behind the pass, still singular
  RobotPass pass_;
  bool is_waiting_ = false;  ///< not used: the span to hand on is in out_
  JointSpan out_;
};

}  // namespace meridian
