// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/cl_block.hpp"
#include "meridian/planner/approach.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "service/core/planner/feed/legs/leg_planner.hpp"
#include "service/core/planner/route/rewind_solutions.hpp"
#include "service/core/planner/route/route_ahead.hpp"
#include "service/core/planner/route/staging.hpp"
#include "service/core/planner/singular/pole/pole_look_ahead.hpp"

namespace meridian {

/// Where the plan has got to.
struct PlanCursor {
  ToolPose pose{Vector3::Zero(), Vector3::UnitZ()};
  JointVector joints{};
  double tool_length_mm = 0;
  bool is_first = true;  ///< no motion block yet: the next one is approached
  std::uint64_t path_index = 0;
  std::uint32_t window = 0;
  std::uint16_t epoch = 0;
  bool has_retracted = false;             ///< the approach goes on from where retract() led
  double cut_mm_per_s = 0;                ///< that the cut that ended there asks for; 0: none did
  std::optional<Vector3> relaxed_from{};  ///< where the pose's axis was programmed, if not there
};

/// Finds the legs of a motion block: which branch and winding, where it stops on the pole, and the
/// approach of the first block. What it stages is checked; on a fault nothing of the block is
/// meant.
class Router {
 public:
  explicit Router(const MachineModel& model) noexcept : model_(model), legs_(model) {}

  /// Cuts are planned for `factor` times their feed.
  void set_feed_factor(double factor) noexcept { feed_factor_ = factor; }

  /// Plans the path from `cursor` to the end of `block`, whose axis is unit, and moves the cursor.
  [[nodiscard]] PathFault route(const ClBlock& block, PlanCursor& cursor, Staging& out) noexcept;

  /// Blocks that are known, among them those that are planned: where branch and winding can be
  /// chosen, the routes that carry farthest through them come first, of these the cheapest. Empty:
  /// the nearest. They stay as they are until this is called again.
  void look_at(std::span<const ClBlock> ahead, const LookAheadSlack& slack) noexcept {
    ahead_ = ahead;
    slack_ = slack;
  }

  /// Who tells of blocks behind those that are routed; nullptr: only look_at() does. What it does
  /// not know yet leaves needs_ahead() true: route() is to be called again then.
  void ask(PoleLookAhead* look_ahead) noexcept { look_ahead_ = look_ahead; }
  [[nodiscard]] bool needs_ahead() const noexcept { return needs_ahead_; }

  /// Axes nearer to the pole than `rad` count as on it, and blocks that pass it nearer run through.
  /// Blocks in inverse time, which bounds how fast the axis turns, only stay there.
  void set_pole_tolerance(double rad) noexcept { on_pole_rad_ = rad; }

  /// Nearer to the pole than `rad` the redundant joint may be turned at rest, the axis inside that
  /// of where it was programmed; a block that leads off from there, but one in inverse time, may
  /// pass the pole so near where that is faster.
  void set_free_cone(double rad) noexcept { free_cone_rad_ = rad; }

  /// Lifts the tool off where the machine rests, along its axis by the clearance as far as travel
  /// allows, in the name of `block`, which is done there: the first part of the approach.
  [[nodiscard]] PathFault retract(const ClBlock& block, PlanCursor& cursor, Staging& out) noexcept;

  /// Brings the first block's begin under the tool. Ways that are lost (RouteAhead) are none: where
  /// no other is left, lost_block() says why, else it is nothing.
  [[nodiscard]] PathFault approach(const ClBlock& block, PlanCursor& cursor, Staging& out) noexcept;
  /// The same to joints that are known: all of them straight there, at the feed of the block (1 rad
  /// counts as 50 mm of path) and the limits of the joints, with no retraction. There the block
  /// begins.
  [[nodiscard]] PathFault approach_joints(const ClBlock& block, const JointVector& to,
                                          PlanCursor& cursor, Staging& out) noexcept;
  [[nodiscard]] const std::optional<BlockReject>& lost_block() const noexcept { return lost_; }
  /// The route that the last approach() found.
  [[nodiscard]] const Approach& last_approach() const noexcept { return last_approach_; }

  /// What leaves its travel, and where the blocks are followed from that show which solution
  /// carries farthest.
  struct RewindCause {
    PathFault fault;
    bool is_in_block = false;  ///< the tool rests on the path of the block, else where it begins
  };
  /// The solutions that a rewind at the rest of `cursor`, ahead of the rest of `block`, may lead
  /// to, best first. needs_ahead() is true where blocks are missing for the answer. The machine has
  /// a redundant joint.
  [[nodiscard]] RewindSolutions find_rewinds(const ClBlock& block, const RewindCause& cause,
                                             const PlanCursor& cursor) noexcept;
  /// Turns to `target` off the part and comes back to where the tool rests, as
  /// RewindPolicy::kRetract says, in the name of `block`, which would leave travel. A fault: there
  /// is no room for it.
  [[nodiscard]] PathFault rewind(const ClBlock& block, const RewindTarget& target,
                                 PlanCursor& cursor, Staging& out) noexcept;

  /// Whether any branch and winding puts the tool on the block's end.
  [[nodiscard]] bool is_reachable(const ClBlock& block, const PlanCursor& cursor) const noexcept;

  /// Largest deviation of the axis in the last route().
  [[nodiscard]] double axis_deviation_rad() const noexcept { return deviation_rad_; }

  /// `axis`, or the pole itself where that is nearer than `within_rad`.
  [[nodiscard]] Vector3 relaxed(const Vector3& axis, double within_rad) noexcept;

 private:
  static constexpr int kMaxCandidates = 24;
  /// Of a block, the share that a leg is: all of it, or none where the block's time is not its own.
  static constexpr double kWhole = 1, kNoPart = 0;

  /// A value of the redundant joint at the end of a route, from one branch and winding.
  struct Candidate {
    JointVector joints{};
    double cost = 0;
    int branch = 0;
    int carries = 0;  ///< blocks ahead, where they were looked at
    std::optional<BlockReject> lost{};
  };
  struct Candidates {
    std::array<Candidate, kMaxCandidates> candidate;
    int count = 0;

    /// Those that carry farthest first, then the cheapest, equal ones as they were found. Takes no
    /// memory.
    void sort() noexcept;
  };

  /// What all legs of a block share.
  struct Job {
    const ClBlock& block;
    MotionKind motion;
    double feed_mm_per_s = 0;
    double share_per_s = 0;
    double feed_factor = 1;
    double on_pole_rad = kPoleDeviation_rad;  ///< axes nearer to the pole count as on it
  };

  [[nodiscard]] Job job_of(const ClBlock& block) const noexcept;
  /// From where it was relaxed to, the axis turns farther along `path` than the `programmed_rad`
  /// that its block in inverse time asks for: no faster than (1.6) of docs/motion.md, behind a cut
  /// that asks for `before_mm_per_s`. What is left of `share_per_s`.
  [[nodiscard]] double bound_turn(const PathPiece& path, double programmed_rad,
                                  double before_mm_per_s, double share_per_s) const noexcept;
  [[nodiscard]] Candidates find_candidates(const ToolPose& pose,
                                           const PlanCursor& cursor) const noexcept;
  /// Sorts `ways`, at `start` on `block`, by what is known of the blocks behind it: of the
  /// program's begin.
  void look_along(const ClBlock& block, const ToolPose& start, double tool_length_mm,
                  Candidates& candidates) const noexcept;
  /// The same for a robot.
  void look_along_arm(const ClBlock& block, const ToolPose& start, double tool_length_mm,
                      Candidates& candidates) const noexcept;
  [[nodiscard]] std::span<const ClBlock> after(const ClBlock& block) const noexcept;
  /// `block` and those behind it, of those that are known.
  [[nodiscard]] std::span<const ClBlock> from(const ClBlock& block) const noexcept;
  using RoutesAhead = std::array<RouteAhead, kMaxCandidates>;
  [[nodiscard]] RoutesAhead ahead_of(const Candidates& candidates) const noexcept;
  static void take_looked(std::span<const RouteAhead> found, Candidates& candidates) noexcept;
  /// The same by what the look-ahead says, where there is one.
  void look_past(const ClBlock& block, const ToolPose& start, double tool_length_mm,
                 Candidates& candidates) noexcept;
  /// Adds the windings of `on`, a solution where the tool rests, that the machine can stand on, the
  /// nearest first.
  void add_windings(const RewindTarget& on, int branch_in_force, const PlanCursor& cursor,
                    RewindSolutions& found) const noexcept;
  /// Sorts `found` by the blocks that follow.
  void look_past_rewind(const ClBlock& block, const RewindCause& cause, const PlanCursor& cursor,
                        RewindSolutions& found) noexcept;
  /// To `target` with the tip at `over`: the axis goes to the pole, the redundant joint turns
  /// there, and the axis comes back on the other side.
  [[nodiscard]] PathFault turn_through_pole(const ToolPose& over, const RewindTarget& target,
                                            const Job& rapid, PlanCursor& cursor,
                                            Staging& out) noexcept;
  [[nodiscard]] PathFault turn_on_branch(const RewindTarget& target, const Job& rapid,
                                         PlanCursor& cursor, Staging& out) noexcept;
  [[nodiscard]] bool is_at_pole(const Vector3& axis) const noexcept;
  [[nodiscard]] PathFault run(const PathPiece& path, const Job& job, double share,
                              PlanCursor& cursor, Staging& out) noexcept;
  [[nodiscard]] PathFault run_held(PathPiece path, double free_end, const Job& job, double share,
                                   PlanCursor& cursor, Staging& out) noexcept;
  /// A route with the axis fixed: on the redundant joint held where it is, or on the branch in
  /// force.
  [[nodiscard]] PathFault run_lift(const PathPiece& path, const Job& job, PlanCursor& cursor,
                                   Staging& out) noexcept;
  [[nodiscard]] int branch_of(const ToolPose& pose, const JointVector& joints,
                              double tool_length_mm) const noexcept;
  /// The joints of `pose` nearest to `joints`, the redundant joint held where the machine has one.
  [[nodiscard]] Solution<double> solve_near(const ToolPose& pose, const JointVector& joints,
                                            double tool_length_mm) const noexcept;
  [[nodiscard]] PathFault run_solved(PathPiece path, const Job& job, double share,
                                     PlanCursor& cursor, Staging& out) noexcept;
  /// `path` ends on the pole.
  [[nodiscard]] PathFault enter_pole(const PathPiece& path, const Job& job, double share,
                                     PlanCursor& cursor, Staging& out) noexcept;
  /// `path` begins on the pole and ends at `end`: turn the redundant joint at rest, then go.
  [[nodiscard]] PathFault leave_pole_by(const PathPiece& path, const JointVector& end,
                                        const Job& job, PlanCursor& cursor, Staging& out) noexcept;
  /// The redundant joint at `share` of `path`, followed back from the joints at its end.
  [[nodiscard]] double follow_back(PathPiece path, const JointVector& end, double share,
                                   double tool_length_mm) const noexcept;
  [[nodiscard]] PathFault turn_free(const ToolPose& pose, double free_end, const Job& job,
                                    PlanCursor& cursor, Staging& out) noexcept;
  [[nodiscard]] PathFault leave_pole(const PathPiece& path, const ToolPose& end, const Job& job,
                                     PlanCursor& cursor, Staging& out) noexcept;
  [[nodiscard]] PathFault pass_pole(const PathPiece& path, const ToolPose& end, double share,
                                    const Job& job, PlanCursor& cursor, Staging& out) noexcept;
  /// `path` runs between two axes off the pole, as near to it as it may be.
  [[nodiscard]] PathFault route_past_pole(const PathPiece& path, const ToolPose& end,
                                          const Job& job, PlanCursor& cursor,
                                          Staging& out) noexcept;
  /// Where a route began.
  struct Begin {
    const PlanCursor& cursor;
    Staging::Mark mark;
  };
  /// `path` begins in the free cone, is nearest to the pole at `share`, and was staged from `begin`
  /// on: stages in place of it the passage of the pole, where that is faster.
  [[nodiscard]] PathFault pass_in_cone(const PathPiece& path, const ToolPose& end, double share,
                                       Job job, const Begin& begin, PlanCursor& cursor,
                                       Staging& out) noexcept;
  /// `path` begins beside the pole, and the redundant joint runs out of travel on the branch in
  /// force: turn it at rest to another branch or winding, then go. `fault`: of the branch in force.
  [[nodiscard]] PathFault leave_otherwise(const PathPiece& path, const ToolPose& end,
                                          const Job& job, const PathFault& fault,
                                          PlanCursor& cursor, Staging& out) noexcept;
  /// Whether the axis stays within `tolerance_rad` of `path` where the redundant joint turns evenly
  /// to `free_end`.
  [[nodiscard]] bool is_straight_passage(const PathPiece& path, double free_end,
                                         const PlanCursor& cursor, double tolerance_rad) noexcept;
  [[nodiscard]] PathFault approach_by(const ToolPose& target, const Candidate& candidate,
                                      const Job& job, PlanCursor& cursor, Staging& out) noexcept;
  /// Lifts a tool that is longer than the one that retract() led off the part as far as that was.
  [[nodiscard]] PathFault lift_longer_tool(const Job& rapid, PlanCursor& cursor,
                                           Staging& out) noexcept;
  /// Fills in what is known of the route once it is staged from `begin` on.
  void describe_approach(const Candidate& candidate, const Job& job, const PlanCursor& from,
                         const Staging::Mark& begin, const Staging& staged) noexcept;
  /// How far the tool leaves a pose along its axis, and the joints there.
  struct Lift {
    double mm = 0;
    JointVector joints{};
  };
  /// The farthest lift from `pose`, up to `whole_mm`, inside travel and the tip box, and past every
  /// keep-out box; 0: none. It follows the branch that `joints` are on.
  [[nodiscard]] Lift find_lift(const ToolPose& pose, const JointVector& joints,
                               double tool_length_mm, double whole_mm) const noexcept;
  [[nodiscard]] Lift find_lift_of_arm(const ToolPose& pose, const JointVector& joints,
                                      double tool_length_mm, double whole_mm) const noexcept;
  /// Why no solution at `target` may be approached.
  [[nodiscard]] PathFault find_target_fault(const ToolPose& target,
                                            const PlanCursor& cursor) const noexcept;
  /// Where the tip leaves its box at `joints`.
  [[nodiscard]] PathFault find_tip_fault(double tool_length_mm,
                                         const JointVector& joints) const noexcept;

  const MachineModel& model_;
  LegPlanner legs_;
  std::span<const ClBlock> ahead_;
  PoleLookAhead* look_ahead_ = nullptr;
  bool needs_ahead_ = false;  ///< of the last route()
  LookAheadSlack slack_;
  std::optional<BlockReject> lost_;                   ///< of the last approach
  Approach last_approach_;                            ///< of the last approach
  Approach retracted_;                                ///< what the last retract() was of it
  ToolPose left_{Vector3::Zero(), Vector3::UnitZ()};  ///< where the last retract() began
  double feed_factor_ = 1;
  double free_cone_rad_ = 0;
  double on_pole_rad_ = kPoleDeviation_rad;
  double deviation_rad_ = 0;
};

}  // namespace meridian
