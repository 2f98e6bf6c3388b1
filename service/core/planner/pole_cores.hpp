// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "service/core/planner/pole_freedom.hpp"
#include "service/core/planner/pole_probes.hpp"
#include "service/core/planner/pole_zone.hpp"

namespace meridian {

inline constexpr double kPoleReach_mm = 20;  ///< of a zone to either side of its core

/// What is settled of a path, ahead of a core that is looked for.
struct SettledPath {
  double end = 0;         ///< u: of the last zone, or of what was handed out
  bool is_begun = false;  ///< there is a zone, or something was handed out
  bool is_held = false;   ///< the free joint rests at the end, close to the pole
  bool is_whole = false;  ///< no more spans come
  int branch = 0;         ///< at the end
};

/// A stretch of path about which a zone is to be sought.
struct PoleCore {
  PolePlace around;       ///< all but the joints
  double nearest = 0;     ///< u: where it is closest to the pole
  bool has_room = false;  ///< for a zone
  /// Its end is not known yet: the free joint comes to rest at this place meanwhile. -1: it is.
  PoleProbes::Place hold = -1;
};

/// Looks along the probes of a path for its cores: a minimum of the distance to the pole, or a
/// stretch on the pole and what comes back to it from no farther than the free joint may be held,
/// whatever it is. Says where a zone about one may begin and end.
///
///     find_next() ─▶ decide() ─▶ find_next() ... until false
///
/// What it says depends on spans and programmed axis alone. Units: mm, rad. Source: docs/motion.md,
/// section 10.
class PoleCores {
 public:
  using Place = PoleProbes::Place;

  enum class Answer : std::uint8_t {
    kNeedsSpans,  ///< too little is known of what is behind: ask again
    kPassed,      ///< what is settled reaches over it
    kFound
  };

  PoleCores(const MachineModel& model, const PoleProbes& probes, const ProgrammedAxis& programmed)
      : probes_(probes), freedom_(model, probes, programmed) {}
  PoleCores(const PoleCores&) = delete;
  PoleCores& operator=(const PoleCores&) = delete;

  /// `tolerance_rad`: of the axis from the programmed one; `is_exact`: from that of the spans.
  void begin(double tolerance_rad, bool is_exact) noexcept;
  /// All that is held back is looked at again.
  void begin_again() noexcept;

  /// Goes on to the next place to decide; false: there is none as far as the path is known.
  [[nodiscard]] bool find_next(const SettledPath& settled) noexcept;
  /// Decides the place that was found.
  [[nodiscard]] Answer decide(PoleCore& out) noexcept;
  /// Whether the core that was decided last goes on behind an excursion.
  [[nodiscard]] bool is_extended() const noexcept { return run_.is_extended; }
  /// True where the core that was decided last is to be found and decided once more, as one that
  /// ends ahead of its first excursion; false: it is that already.
  [[nodiscard]] bool shorten() noexcept;
  /// The zone about `core` was taken: what is behind it comes next.
  void take(const PoleCore& core) noexcept {
    if (core.hold >= 0) place_ = core.hold;
  }

  /// All in front of this place is decided.
  [[nodiscard]] Place place() const noexcept { return place_; }

  /// What is known of a core stays while spans behind it come, so that a way along the pole is
  /// walked once, however long.
  struct Run {
    Place place = -1;           ///< the minimum among the probes
    Place first = 0, last = 0;  ///< the run of places on the pole about it
    Place seen = 0;             ///< farther on the path only lingers beside it
    double nearest = 0;         ///< u
    bool has_left = false;      ///< `seen` is on or behind an excursion
    bool is_extended = false;   ///< and so is `last`, or the core begins or ends beside the pole
  };
  /// All that a trial of another core changes.
  struct State {
    SettledPath settled;
    Place place = 0;       ///< first that is not decided
    Place entered = -1;    ///< of the run of places on the pole that `place` is in
    Place shortened = -1;  ///< a core about this place ends ahead of its first excursion
    Run run;               ///< that is being decided
  };
  [[nodiscard]] State state() const noexcept {
    return {settled_, place_, entered_, shortened_, run_};
  }
  void go_back(const State& to) noexcept;

 private:
  [[nodiscard]] bool is_minimum(bool is_last) const noexcept;
  /// Finds what is known of the core about the place.
  void follow() noexcept;
  /// The core that is being decided goes on to `next`.
  void extend_to(Place next) noexcept;
  [[nodiscard]] bool may_extend() const noexcept { return place_ != shortened_; }
  [[nodiscard]] PolePlace around() const noexcept;
  /// Where in a core from `begin`, whose end is not known yet, the free joint may come to rest
  /// meanwhile; -1: its end is waited for.
  [[nodiscard]] Place find_hold(double begin) const noexcept;
  [[nodiscard]] double find_room_behind(double core_end) const noexcept;
  /// Where the path comes onto the pole that it ends on.
  [[nodiscard]] double find_last_way_onto() const noexcept;
  /// Whether enough of the path behind `u` is known.
  [[nodiscard]] bool is_known_behind(double u) const noexcept;
  /// Whether the path counts as on the pole at `place`.
  [[nodiscard]] bool dwells(Place place) const noexcept;
  /// Whether it is so close to it that the free joint may be held there.
  [[nodiscard]] bool lingers(Place place) const noexcept;
  /// Whether it may be held there, though that is farther off, whatever it is.
  [[nodiscard]] bool is_free(Place place) const noexcept;
  /// Whether the free joint rests on the way to `place`, and may go on resting there.
  [[nodiscard]] bool rests_at(Place place) const noexcept;
  [[nodiscard]] bool is_in_core(Place place) const noexcept {
    return dwells(place) || rests_at(place) || (run_.place == place && run_.is_extended);
  }

  const PoleProbes& probes_;
  PoleFreedom freedom_;
  double tolerance_rad_ = 0;
  bool is_exact_ = false;
  SettledPath settled_;
  Place place_ = 0, entered_ = -1, shortened_ = -1;  ///< State tells what they are
  Run run_;
};

}  // namespace meridian
