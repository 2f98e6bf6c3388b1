// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/path_piece.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/feed/legs/leg.hpp"
#include "service/core/planner/feed/legs/leg_feed.hpp"
#include "service/core/planner/feed/legs/path_choice.hpp"
#include "service/core/planner/route/staging.hpp"

namespace meridian {

/// Plans one leg: checks its joints and stages its pieces, each of them from rest to rest.
///
/// Where the joints follow the leg evenly the motion of constant bounds is the fastest. Where they
/// do not, the feed planner shapes it along the true derivatives (LegFeed).
///
/// Beside the pole the joints' derivatives grow without bound as the distance shrinks. There the
/// leg is cut at places graded by the distance to the pole; every run between two of them can be
/// one piece, in path length or in azimuth, and a shortest path through the runs picks the fastest.
class LegPlanner {
 public:
  explicit LegPlanner(const MachineModel& model);

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

  void set_nodes(const PathPiece& path) noexcept;
  [[nodiscard]] PathFault append_cells(CellTable& table, const PathPiece& path, double begin,
                                       double end, int cells, JointVector& joints) noexcept;
  [[nodiscard]] PathFault measure(const Leg& leg, JointVector& joints) noexcept;
  void find_fastest_runs(const Leg& leg) noexcept;
  void relax_from(int first, bool by_azimuth, const Leg& leg) noexcept;
  /// Stages `leg` as the feed planner has it. False: that gains nothing.
  [[nodiscard]] bool plan_feed(const Leg& leg, Staging& out, JointVector& joints) noexcept;
  [[nodiscard]] PathFault stage_runs(const Leg& leg, Staging& out, JointVector& joints) noexcept;
  [[nodiscard]] MotionChoice choose(const Leg& leg, std::span<const JointCell> cells,
                                    double length) const noexcept;
  [[nodiscard]] PathFault stage_run(const Leg& leg, const Node& from, const Node& to, Staging& out,
                                    JointVector& joints) noexcept;
  [[nodiscard]] bool stage_times(const Leg& leg, const PathPiece& piece, const MotionChoice& choice,
                                 std::span<const JointCell> cells, double offset,
                                 Staging& out) const noexcept;

  const MachineModel& model_;
  JointCaps caps_, fault_caps_;  ///< of the leg being planned
  PolePassage passage_;
  std::array<Node, kMaxNodes> nodes_;
  int node_count_ = 0;
  MotionChoice whole_;  ///< of the leg that is not cut
  CellTable cells_, azimuth_cells_;
  LegFeed feed_;
};

/// Unit vector of the pole (W) that is nearest to `axis`.
[[nodiscard]] Vector3 find_nearest_pole(const MachineModel& model, const Vector3& axis) noexcept;

}  // namespace meridian
