// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "service/core/path/index_ring.hpp"
#include "service/core/planner/joint_span.hpp"
#include "service/core/planner/pole_cores.hpp"
#include "service/core/planner/pole_foresight.hpp"
#include "service/core/planner/pole_probes.hpp"
#include "service/core/planner/pole_zone.hpp"

namespace meridian {

/// From spans of the path to spans that joints follow: finds the places where the path comes close
/// to the pole, lets the free joint take a shorter way there inside the axis tolerance, and follows
/// branch and winding behind it.
///
///     push(span) ... finish() ─▶ next() ... next() until it returns nullptr
///
/// Where the axis is within 11.5° of the pole, spans are held back by up to 61 mm of u, until it
/// is known how close they come, on the pole by up to 101 mm. What comes out depends on the spans
/// alone, not on when they came.
/// Where it stays on the pole, however long, the free joint comes to rest and is held until the
/// path leads off again. A machine without a pole gets its spans as they are. Where no zone helps,
/// spans are cut about the nearest point, so that cells of the feed are as short as the free
/// joint's turn is sharp. Fixed store. Units: mm, rad. Context: planner thread. Source:
/// docs/motion.md, section 10. Proof: tests/property/planner/smooth_planner_test.cpp and
/// pole_linger_test.cpp.
class PoleCorridor {
 public:
  /// `foresight`: blocks behind the spans, nullptr: nothing is known of them.
  explicit PoleCorridor(const MachineModel& model, PoleForesight* foresight = nullptr);

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
  /// Whether next() returned nullptr because the foresight waits for blocks: no span is needed.
  [[nodiscard]] bool needs_ahead() const noexcept { return needs_ahead_; }

  /// Whether no way on was found from where the free joint rests. What was handed out stays valid,
  /// nothing comes behind it.
  [[nodiscard]] bool has_failed() const noexcept { return has_failed_; }
  /// The first span that is not handed out, or not all of it; nullptr: there is none.
  [[nodiscard]] const BandSpan* first_held() const noexcept {
    return probes_.is_empty() ? nullptr : &probes_.front();
  }

  /// The machine turned its free joint by `by` rad (whole turns) ahead of what next() gave last,
  /// and will be at `joints` at its end. What next() gave is not touched, a zone that it lies in
  /// keeps its shape, all zones behind are sought anew on the winding in force now.
  void wind(double by, const JointVector& joints) noexcept;

  /// Whether what is left of the zone that next() is in, if any, stays inside travel with the free
  /// joint turned by `by`.
  [[nodiscard]] bool fits_zone(double by) const noexcept;

 private:
  static constexpr std::size_t kCuts = 128;
  static constexpr std::size_t kPending = 64;
  static constexpr std::size_t kMostZones = 2;  ///< about one core
  static constexpr int kMostTried = 6;          ///< cores in place of one with its excursions

  /// About one core: where the free joint is held first, that and the turn off it.
  struct Zones {
    std::array<PoleZone, kMostZones> of;
    std::size_t count = 0;
  };
  /// All that taking zones changes.
  struct Settled {
    PoleCores::State cores;
    std::array<PoleZone, kMostZones * kMostTried> zones;  ///< that were taken behind some place
    std::size_t zone_count = 0;
    std::int64_t pending_end = 0;
    double known_u = 0;
    JointVector known{};
    int branch = 0;
    bool is_held = false;
  };

  [[nodiscard]] double emitted_u() const noexcept { return probes_.front().u0 + emitted_x_; }
  [[nodiscard]] SettledPath settled() const noexcept;
  [[nodiscard]] PoleTask pole_task() const noexcept;

  /// Looks for cores as far as enough of what follows is there.
  void scan() noexcept;
  /// Finds out how far ways behind the core carry; false: blocks are missing.
  [[nodiscard]] bool foresee(PolePlace& around) noexcept;
  [[nodiscard]] bool returns_to_pole(const PolePlace& around) const noexcept;
  void ask(const PolePlace& around) noexcept;
  /// Takes a zone about `core`, or cuts the spans there, or leaves it to be decided once more
  /// without its excursions.
  void settle(PoleCore& core) noexcept;
  [[nodiscard]] bool take_zone(PoleCore& core) noexcept;
  /// What is settled now, with the zones from index `from` on.
  [[nodiscard]] Settled settled_state(std::int64_t from) const noexcept;
  [[nodiscard]] Settled settled_state() const noexcept {
    return settled_state(pending_.end_index());
  }
  /// All is as it was in `to`, which has the zones from index `from` on.
  void go_back(const Settled& to, std::int64_t from) noexcept;
  /// Takes zones about the cores that there are in place of the one decided last where that ends
  /// ahead of its excursions, as far as `end`. False: there is no such way, or not yet.
  [[nodiscard]] bool try_shorter(double end) noexcept;
  /// Whether they take less time than the zone about `core` that was taken. Nothing is changed.
  [[nodiscard]] bool is_shorter_faster(const PoleCore& core, const Settled& before) noexcept;
  /// Takes the best zone about `around`; false: there is none.
  [[nodiscard]] bool find_zone(const PolePlace& around, bool is_held) noexcept;
  /// From where the free joint rests: holds it farther into the core, where that takes less time
  /// than `zones` or there are none.
  void hold_on(const PolePlace& around, Zones& zones) const noexcept;
  void add_cuts(double nearest) noexcept;
  void add_cut(double u) noexcept;
  /// Joints of the exact way at `u`, the windings followed from where they are known.
  [[nodiscard]] JointVector follow_to(double u) const noexcept;
  /// `zone` is the last one: branch and winding behind it are known.
  void take(const PoleZone& zone) noexcept;
  /// Whether a zone is partly out.
  [[nodiscard]] bool is_in_zone() const noexcept;
  [[nodiscard]] bool may_emit() const noexcept;
  void emit() noexcept;

  const MachineModel& model_;
  PoleForesight* foresight_;
  bool has_pole_ = false;  ///< one that matters
  bool is_exact_ = false;  ///< of the policies the one that never eases
  double tool_length_mm_ = 0, tolerance_rad_ = 0;
  ProgrammedAxis programmed_;
  PoleProbes probes_;  ///< spans that are held back
  PoleCores cores_;
  double emitted_x_ = 0;  ///< of the first span held, what is out already
  double known_u_ = 0;    ///< winding and branch behind all zones are known there
  JointVector known_{};
  int branch_ = 0;      ///< behind all zones
  int out_branch_ = 0;  ///< where spans are handed out
  IndexRing<PoleZone> pending_;
  std::array<double, kCuts> cuts_{};  ///< ascending
  std::size_t cut_count_ = 0;
  bool is_finished_ = false;
  bool is_held_ = false;      ///< behind all zones the free joint rests, close to the pole
  bool is_out_held_ = false;  ///< the same where spans are handed out
  bool has_failed_ = false;
  double asked_u_ = -1;  ///< from where the foresight was asked
  bool needs_ahead_ = false;
  JointSpan out_;
};

}  // namespace meridian
