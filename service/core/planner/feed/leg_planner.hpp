// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/path_piece.hpp"
#include "service/core/planner/feed/joint_cells.hpp"
#include "service/core/planner/feed/path_choice.hpp"
#include "service/core/planner/route/staging.hpp"

namespace meridian {

/// A smooth stretch of a block: one path piece as a whole, and how fast it may be run.
struct Leg {
  PathPiece path;            ///< names, kind and joints_begin filled in
  double feed_mm_per_s = 0;  ///< programmed tip feed; 0: limited by the joints alone
  double share_per_s = 0;    ///< inverse time: largest d(share of the leg)/dt; 0: none
  double feed_factor = 1;    ///< on what is programmed: `share_per_s`, without one `feed_mm_per_s`
  std::uint32_t window = 0;
};

/// Plans one leg: checks its joints, splits it where that is faster, and stages its pieces, each of
/// them from rest to rest.
///
/// Beside the pole the joints' derivatives grow without bound as the distance shrinks. There the
/// leg is cut at places graded by the distance to the pole; every run between two of them can be
/// one piece, in path length or in azimuth, and a shortest path through the runs picks the fastest.
class LegPlanner {
 public:
  explicit LegPlanner(const MachineModel& model) noexcept;

  /// Stages the pieces of `leg` from `joints`, which become the joints at its end.
  [[nodiscard]] PathFault plan(const Leg& leg, Staging& out, JointVector& joints) noexcept;

 private:
  static constexpr int kMaxNodes = 96;

  /// A place where the leg may be cut.
  struct Node {
    double turn = 0;           ///< of the axis, from the leg's begin
    double s = 0;              ///< path length there
    double azimuth = 0;        ///< about the pole, from the nearest point
    bool has_azimuth = false;  ///< near enough for pieces in azimuth
    int cell = 0;              ///< first cell behind it, by path length
    int azimuth_cell = 0;      ///< first cell behind it, by azimuth
    double fastest = 0;        ///< least time from the begin
    int from = 0;              ///< node before it on that way
    bool by_azimuth = false;   ///< how the piece from there runs
  };

  void place_nodes(const PathPiece& path) noexcept;
  [[nodiscard]] PathFault append_cells(CellTable& table, const PathPiece& path, double begin,
                                       double end, int cells, JointVector& joints) noexcept;
  [[nodiscard]] PathFault measure(const Leg& leg, JointVector& joints) noexcept;
  void find_fastest_runs(const Leg& leg, const JointCaps& caps) noexcept;
  void relax_from(int first, bool by_azimuth, const Leg& leg, const JointCaps& caps) noexcept;
  /// The tip feed that is programmed, also by inverse time.
  [[nodiscard]] double find_tip_feed(const Leg& leg) const noexcept;
  [[nodiscard]] double find_feed_velocity(const Leg& leg, double share_rate) const noexcept;
  [[nodiscard]] PathFault stage_run(const Leg& leg, const Node& from, const Node& to, Staging& out,
                                    JointVector& joints) noexcept;
  [[nodiscard]] bool stage_times(const Leg& leg, const PathPiece& piece, const MotionChoice& choice,
                                 std::span<const JointCell> cells, double offset,
                                 Staging& out) const noexcept;

  const MachineModel& model_;
  JointCaps caps_, fault_caps_;  ///< of the leg being planned
  PolePassage passage_;
  double tip_length_ = 0;
  std::array<Node, kMaxNodes> nodes_;
  int node_count_ = 0;
  CellTable cells_, azimuth_cells_;
};

/// Unit vector of the pole (W) that is nearest to `axis`.
[[nodiscard]] Vector3 find_nearest_pole(const MachineModel& model, const Vector3& axis) noexcept;

}  // namespace meridian
