// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "service/core/path/index_ring.hpp"
#include "service/core/planner/feed/cells/joint_span.hpp"
#include "service/core/planner/singular/pole/pole_look_ahead.hpp"
#include "service/core/planner/singular/pole/pole_probes.hpp"
#include "service/core/planner/singular/pole/pole_stretches.hpp"
#include "service/core/planner/singular/pole/pole_string.hpp"
#include "service/core/planner/singular/pole/pole_zone.hpp"

namespace meridian {

/// From spans of the path to spans that joints follow: finds the places where the path comes close
/// to the pole, lets the redundant joint take a shorter course there inside the axis tolerance, and
/// follows branch and winding behind it.
///
///     push(span) ... finish() ─▶ next() ... next() until it returns nullptr
///
/// Where the axis is within 11.5° of the pole, spans are held back by up to 61 mm of u, until it
/// is known how close they come, on the pole by up to 101 mm. What comes out depends on the spans
/// alone, not on when they came.
/// Where it stays on the pole, however long, the redundant joint comes to rest and is held until
/// the path leads off again. A machine without a pole gets its spans as they are. Where no zone
/// helps, spans are cut about the nearest point, so that cells of the feed are as short as the free
/// joint's turn is sharp. Fixed store. Units: mm, rad. Context: planner thread. Source:
/// docs/motion.md, section 10. Proof: tests/property/planner/smooth_planner_test.cpp and
/// pole_linger_test.cpp.
class PoleCorridor {
 public:
  /// `look_ahead`: blocks behind the spans, nullptr: nothing is known of them.
  explicit PoleCorridor(const MachineModel& model, PoleLookAhead* look_ahead = nullptr);

  /// Where a path starts, at rest.
  struct Start {
    JointVector joints{};
    int branch = 0;
    double tool_length_mm = 0;
    Vector3 axis = Vector3::UnitZ();  ///< programmed there
    double tolerance_rad = 0;         ///< of the axis from the programmed one, smoothing included
    bool is_on_pole = false;          ///< all of the path: spans are handed on as they are
  };
  void begin(const Start& start) noexcept;

  /// The axis programmed at `u`, in order: on a great circle between two of them. Ahead of spans.
  void mark(double u, const Vector3& axis) noexcept { programmed_.add(u, axis); }

  /// Takes the next span. Only after next() returned nullptr.
  void push(const BandSpan& span) noexcept { probes_.push(span); }
  /// No more spans.
  void finish() noexcept { is_finished_ = true; }

  /// Returns the next span, nullptr where more are needed; valid until the next call.
  [[nodiscard]] const JointSpan* next() noexcept;
  /// Whether next() returned nullptr because the look-ahead waits for blocks: no span is needed.
  [[nodiscard]] bool needs_ahead() const noexcept { return search_ == Search::kNeedsAhead; }

  /// Whether no route on was found from where the redundant joint rests. What was handed out stays
  /// valid, nothing comes behind it.
  [[nodiscard]] bool has_failed() const noexcept { return search_ == Search::kFailed; }
  /// The first span that is not handed out, or not all of it; nullptr: there is none.
  [[nodiscard]] const BandSpan* first_held() const noexcept {
    return probes_.is_empty() ? nullptr : &probes_.front();
  }

  /// The machine turned its redundant joint by `by` rad (whole turns) ahead of what next() gave
  /// last, and will be at `joints` at its end. What next() gave is not touched, a zone that it lies
  /// in keeps its shape, all zones behind are sought anew on the winding in force now.
  void wind(double by, const JointVector& joints) noexcept;
  /// The same where it went to `branch`, as may_change_branch() allows.
  void change_branch(int branch, const JointVector& joints) noexcept {
    out_course_.branch = branch;
    wind(0, joints);
  }
  /// Whether the redundant joint follows the path where next() is.
  [[nodiscard]] bool may_change_branch() const noexcept {
    return !is_in_zone() && !out_course_.is_held;
  }

  /// Whether what is left of the zone that next() is in, if any, stays inside travel with the free
  /// joint turned by `by`.
  [[nodiscard]] bool fits_zone(double by) const noexcept;

 private:
  /// What the search for stretches has come to.
  enum class Search : std::uint8_t {
    kGoesOn,
    kNeedsAhead,  ///< the look-ahead waits for blocks
    kFailed       ///< there is no route on from where the redundant joint rests
  };
  /// How the joints go on behind zones.
  struct Course {
    int branch = 0;
    bool is_held = false;  ///< the redundant joint is not exact, and goes by
    double rate = 0;       ///< this by u
  };

  static constexpr std::size_t kCuts = 1024;
  static constexpr std::size_t kPending = 1024;

  [[nodiscard]] double emitted_u() const noexcept { return probes_.front().u0 + emitted_x_; }
  [[nodiscard]] SettledPath settled() const noexcept;

  /// Looks for stretches as far as enough of what follows is there.
  void scan() noexcept;
  /// Finds out how far routes behind the stretch carry; false: blocks are missing.
  [[nodiscard]] bool foresee(PolePass& pass) noexcept;
  [[nodiscard]] bool returns_to_pole(const PolePass& pass) const noexcept;
  void ask(const PolePass& pass) noexcept;
  /// Drives the redundant joint along the stretch, or cuts the spans there.
  void settle(PoleStretch& stretch) noexcept;
  /// The course of the redundant joint along the stretch, empty: the exact one, or none was found.
  /// Where no exact path leads, shorter stretches are tried as well; also where it ends on the
  /// pole: there it gives the redundant joint no direction, so a string that ends there is the
  /// better.
  [[nodiscard]] std::span<const PoleZone> find_string(PoleStretch& stretch) noexcept;
  void lead_to(PolePass& pass) const noexcept;
  [[nodiscard]] bool may_be_exact(const PolePass& pass) const noexcept;
  [[nodiscard]] bool is_on_pole(const PoleStretch& stretch) const noexcept;
  void add_cuts(double nearest) noexcept;
  void add_cut(double u) noexcept;
  /// Joints of the exact path at `u`, the windings followed from where they are known.
  [[nodiscard]] JointVector follow_to(double u) const noexcept;
  /// `piece` is the last one of a stretch: branch and winding behind it are known.
  void know_after(const PoleZone& piece) noexcept;
  /// Whether a stretch is partly out.
  [[nodiscard]] bool is_in_zone() const noexcept;
  [[nodiscard]] bool may_emit() const noexcept;
  void emit() noexcept;

  const MachineModel& model_;
  PoleLookAhead* look_ahead_;
  bool has_pole_ = false;  ///< one that matters
  bool is_exact_ = false;  ///< of the policies the one that never relaxes the axis
  double tool_length_mm_ = 0, tolerance_rad_ = 0;
  ProgrammedAxis programmed_;
  PoleProbes probes_;  ///< spans that are held back
  PoleStretches stretches_;
  PoleString string_;
  double emitted_x_ = 0;  ///< of the first span held, what is out already
  double known_u_ = 0;    ///< winding and branch behind all zones are known there
  JointVector known_{};
  Course course_;      ///< behind all zones
  Course out_course_;  ///< where spans are handed out
  IndexRing<PoleZone> pending_;
  std::array<double, kCuts> cuts_{};  ///< ascending
  std::size_t cut_count_ = 0;
  bool is_finished_ = false;
  Search search_ = Search::kGoesOn;
  double asked_u_ = -1;  ///< from where the look-ahead was asked
  JointSpan out_;
};

}  // namespace meridian
