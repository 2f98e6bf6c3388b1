// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "service/core/planner/singular/pole/pole_probes.hpp"
#include "service/core/planner/singular/pole/pole_zone.hpp"

namespace meridian {

inline constexpr double kPoleReach_mm = 20;  ///< of a stretch to either side of what is close

/// What is settled of a path, ahead of a stretch that is looked for.
struct SettledPath {
  double end = 0;         ///< u: of the last stretch, or of what was handed out
  bool is_begun = false;  ///< there is a stretch, or something was handed out
  bool is_held = false;   ///< at the end the redundant joint is not exact: a stretch goes on there
  bool is_whole = false;  ///< no more spans come
  int branch = 0;         ///< at the end
};

/// A stretch of path close to the pole.
struct PoleStretch {
  PolePass pass;                               ///< all but the joints
  PoleProbes::ProbeIndex first = 0, last = 0;  ///< of the path close to the pole
  double nearest = 0;                          ///< u: where it comes closest first
  double close_begin = 0, close_end = 0;       ///< u: between them the path is close to the pole
  bool has_room = false;  ///< the redundant joint may go another route than the exact one there
};

/// Looks along the probes of a path for stretches close to the pole, or minima of the distance
/// farther off, and says where the redundant joint may leave the exact path about one and be back.
///
///     find_next() ─▶ decide() ─▶ find_next() ... until false
///
/// What it says depends on spans alone. Units: mm, rad. Source: docs/motion.md, section 10.
class PoleStretches {
 public:
  using ProbeIndex = PoleProbes::ProbeIndex;

  enum class Answer : std::uint8_t {
    kNeedsSpans,  ///< too little is known of what is behind: ask again
    kPassed,      ///< what is settled reaches over it
    kFound
  };

  explicit PoleStretches(const PoleProbes& probes) noexcept : probes_(probes) {}
  PoleStretches(const PoleStretches&) = delete;
  PoleStretches& operator=(const PoleStretches&) = delete;

  /// `tolerance_rad`: of the axis from the programmed one.
  void begin(double tolerance_rad) noexcept;
  /// All that is held back is looked at again.
  void begin_again() noexcept;

  /// Goes on to the next place to decide; false: there is none as far as the path is known.
  [[nodiscard]] bool find_next(const SettledPath& settled) noexcept;
  /// Decides the place that was found. Behind anything but kNeedsSpans it is done with it.
  [[nodiscard]] Answer decide(PoleStretch& out) noexcept;
  /// Lets a stretch reach no farther than `reach_mm` to either side of what is close, where the
  /// exact path leads there. False: it does not reach that far.
  [[nodiscard]] bool shorten(PoleStretch& stretch, double reach_mm) const noexcept;
  /// Lets what is close begin nearer to the end of the stretch, which lies on the pole: where a
  /// zone's tolerances begin, however far off the last probe is, then nearer. False: no nearer.
  [[nodiscard]] bool narrow_onto_end(PoleStretch& stretch) const noexcept;
  /// Takes the last answer back.
  void go_back_to(ProbeIndex probe) noexcept { probe_ = probe; }

  /// All in front of this place is decided.
  [[nodiscard]] ProbeIndex probe() const noexcept { return probe_; }
  /// Whether the path is closest to the pole there of what is around.
  [[nodiscard]] bool is_minimum(ProbeIndex probe) const noexcept;

 private:
  /// What is known of a stretch stays while spans behind it come.
  struct Run {
    ProbeIndex first = -1;  ///< where it was found
    ProbeIndex last = 0;    ///< of what is close
    ProbeIndex seen = 0;    ///< looked at as far as here
    bool has_left = false;  ///< there is nothing close behind any more
  };

  /// Whether the path is so close to the pole there that it belongs to a stretch.
  [[nodiscard]] bool is_close(ProbeIndex probe) const noexcept;
  [[nodiscard]] bool ends_path(ProbeIndex probe) const noexcept;
  /// Whether enough of the path behind `u` is known.
  [[nodiscard]] bool is_known_after(double u) const noexcept;
  [[nodiscard]] double nearest_about(ProbeIndex probe) const noexcept;
  [[nodiscard]] double snapped(double u) const noexcept;
  void follow() noexcept;
  [[nodiscard]] ProbeIndex find_hold(double begin) const noexcept;
  [[nodiscard]] double find_room_after(double core_end) const noexcept;
  void set_begin(PoleStretch& out, double core_begin) const noexcept;
  void set_end(PoleStretch& out, double core_end) const noexcept;

  const PoleProbes& probes_;
  double tolerance_rad_ = 0;
  SettledPath settled_;
  ProbeIndex probe_ = 0;
  Run run_;
};

}  // namespace meridian
