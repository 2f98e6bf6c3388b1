// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>

#include "meridian/path/band_spline.hpp"
#include "service/core/path/index_ring.hpp"
#include "service/core/planner/feed/joint_span.hpp"
#include "service/core/planner/singular/robot_pass.hpp"

namespace meridian {

/// What passes may leave of the tolerances `asked` about the programmed path.
[[nodiscard]] AheadSlack pass_slack(const MachineModel& model, const AheadSlack& asked) noexcept;

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
  [[nodiscard]] double distance_of_pose(Singularity at, const ToolPose& pose,
                                        int branch) const noexcept;
  [[nodiscard]] double distance_at(Singularity at, double u, int branch) const noexcept;
  [[nodiscard]] double distance_at(Singularity at, double u) const noexcept {
    return distance_at(at, u, branch_);
  }
  [[nodiscard]] double tolerance(Singularity at) const noexcept {
    return at == Singularity::kWrist ? axis_tolerance_rad_ : tip_tolerance_mm_;
  }
  [[nodiscard]] std::int64_t end_probe() const noexcept { return kProbes * spans_.end_index(); }
  [[nodiscard]] double end_u() const noexcept;
  [[nodiscard]] double emitted_u() const noexcept;

  /// Decides about minima of the distance as far as enough of what follows is there.
  void scan() noexcept;
  /// Takes a pass about `nearest`, if there is one: of both singular places where the other one is
  /// as near. False: not enough of what follows is there.
  [[nodiscard]] bool settle(Singularity at, double nearest) noexcept;
  /// What a pass is about, and how far it may lead.
  struct PlaceOfPass {
    double nearest = 0, last_nearest = 0;
    double limit = std::numeric_limits<double>::infinity();
    bool may_be_narrow = false;
  };
  [[nodiscard]] bool try_pass(Singularity at, const PlaceOfPass& place) noexcept;
  /// The same with joints at rest at its end where that is nearer than so many `tolerances`.
  [[nodiscard]] bool try_resting(Singularity at, const PlaceOfPass& place,
                                 double tolerances) noexcept;
  /// Where the path is nearest to the other singular place, if that is inside its tolerance ahead
  /// of `to`; the pass is about `from`.
  [[nodiscard]] std::optional<double> find_other(Singularity at, double from,
                                                 double to) const noexcept;
  [[nodiscard]] std::optional<double> find_wrist_straight_through(double from,
                                                                  double to) const noexcept;
  /// Whose joint rests behind the last pass, as the path is singular there.
  [[nodiscard]] std::optional<Singularity> held_at() const noexcept;
  [[nodiscard]] bool is_minimum(Singularity at, std::int64_t probe) const noexcept;
  [[nodiscard]] double refine_minimum(Singularity at, std::int64_t probe,
                                      int branch) const noexcept;
  [[nodiscard]] bool is_out_of_reach(const Held& held) const noexcept;
  [[nodiscard]] JointVector follow_to(double u) const noexcept;
  [[nodiscard]] bool may_emit() const noexcept;
  void emit() noexcept;

  const MachineModel& model_;
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
  /// Behind the pass the joint of that place rests, the path still singular.
  std::array<bool, kSingularities> is_held_{};
  int turns_ = 0;                         ///< passes in a row that turned joints at rest
  Singularity at_ = Singularity::kWrist;  ///< the place of pass_
  RobotPass pass_;
  bool is_waiting_ = false;  ///< not used: the span to hand on is in out_
  JointSpan out_;
};

}  // namespace meridian
