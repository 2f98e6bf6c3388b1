// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "meridian/path/block_reject.hpp"
#include "meridian/path/cl_block.hpp"
#include "meridian/planner/approach.hpp"
#include "meridian/planner/motion_port.hpp"
#include "meridian/planner/rewind.hpp"

namespace meridian {

class PoleLookAhead;

enum class PlanStatus : std::uint8_t {
  kOk,      ///< published (nothing, where the block does not move)
  kNoRoom,  ///< nothing was published: call again with the same block when the port has room
  kRefused  ///< nothing was published for it, nor will be for later blocks until begin()
};

struct PlanResult {
  PlanStatus status = PlanStatus::kOk;
  BlockReject reject;
  double axis_deviation_rad = 0;  ///< largest deviation of the axis beside the pole
  Rewind rewind;                  ///< made ahead of the block, where it is_made()
};

/// Within this distance of the pole the programmed axis is relaxed onto the pole: nearer, the turn
/// of the redundant joint would be made of rounding. 0.00046 deg.
inline constexpr double kPoleDeviation_rad = 8e-6;

/// The plain planner: every block from rest to rest, tip on its line or arc, axis on its great
/// circle, every joint inside its limits at every override, feed never exceeded.
///
/// Where a joint would leave its travel in a block, another winding or branch keeps it inside and
/// the machine's file says how, the machine goes there ahead of the block, off the part
/// (PlanResult::rewind).
///
/// One window per block, without a tail: it ends at rest. The joints of the whole path between two
/// blocks are checked before anything of it is published. What a block becomes depends on the
/// blocks before it and on begin() alone. plan() allocates nothing, throws nothing and needs no
/// clock. Method and formulas: docs/motion.md. Context: planner thread. Proof: tests/unit/planner,
/// tests/property/planner.
class RestToRestPlanner {
 public:
  explicit RestToRestPlanner(const MachineModel& model, ToolTable tools = {});
  ~RestToRestPlanner();
  RestToRestPlanner(const RestToRestPlanner&) = delete;
  RestToRestPlanner& operator=(const RestToRestPlanner&) = delete;

  /// Between two programs: takes `tools` into use, and leaves there those that were, so that
  /// nothing is allocated or freed here.
  void swap_tools(ToolTable& tools) noexcept;

  /// Starts a program from joints at rest. Its first motion block is approached: retract along the
  /// tool axis by the clearance as far as travel allows, joint move, down at approach feed. In an
  /// epoch that saw a program before, pieces and windows go on being counted. `retracts_first`: the
  /// tool may stand in the part, so that where actions (auxiliary, tool) come before any motion,
  /// the tool is retracted before the first of them, and the approach goes on from there.
  /// `first_joints`: where the program begins, be it another branch or winding than the nearest;
  /// the approach is all joints straight there, at the feed of the first motion block (1 rad counts
  /// as 50 mm of path), with no retraction.
  void begin(const JointVector& at_rest, double tool_length_mm, std::uint16_t epoch,
             bool retracts_first = false,
             const std::optional<JointVector>& first_joints = std::nullopt) noexcept;

  /// Blocks that are going to be planned, the first motion block of the program first: the approach
  /// and the routes off the pole among them take the branch and winding that carry farthest. They
  /// must stay until this is called again, or begin(). A program that leaves travel among them
  /// whatever is chosen, and where no rewind helps, is refused with its first motion block, in
  /// the name of the block that leaves. The slack says how far from the programmed path the blocks
  /// may be cut: what that can make of a joint's place is no reason to refuse.
  void look_at(std::span<const ClBlock> ahead, double tip_slack_mm = 0,
               double axis_slack_rad = 0) noexcept;

  /// Who says how far solutions behind a block that ends off the pole, or behind a rewind, carry;
  /// nullptr: look_at() does.
  /// Where it waits for blocks, plan() gives kNoRoom and needs_ahead() is true.
  void ask(PoleLookAhead* look_ahead) noexcept;
  [[nodiscard]] bool needs_ahead() const noexcept;

  /// Where a block begins nearer to the pole than `rad` and the redundant joint would leave its
  /// travel on it, the joint is turned at rest to another branch or winding that carries it, with
  /// the axis inside `rad` (PlanResult::axis_deviation_rad). 0, which begin() sets: never.
  void set_free_cone(double rad) noexcept;

  /// Axes of blocks nearer to the pole than nearly all of `rad` are taken for the pole, and blocks
  /// that pass it so near run through it, where that leads anywhere
  /// (PlanResult::axis_deviation_rad). Never less than kPoleDeviation_rad, which begin() sets.
  /// Proof: tests/property/planner/pole_rest_test.cpp.
  void set_pole_tolerance(double rad) noexcept;

  /// The cuts that come are planned for `factor` times their feed, at least 1; the machine's
  /// highest feed bounds it.
  void set_feed_factor(double factor) noexcept;

  /// Plans and publishes one block.
  [[nodiscard]] PlanResult plan(const ClBlock& block, MotionWriter& writer) noexcept;

  /// Takes the approach of the program, once, when it is published; false: not by now.
  [[nodiscard]] bool take_approach(Approach& out) noexcept;

  /// Where another planner takes over from this one, or gives back: the pose and joints at the end
  /// of what was published, and the names that come next in the epoch.
  struct Junction {
    ToolPose pose{Vector3::Zero(), Vector3::UnitZ()};
    JointVector joints{};
    double tool_length_mm = 0;
    std::uint16_t epoch = 0;
    std::uint64_t path_index = 0;
    std::uint32_t window = 0;
    bool is_first = true;  ///< no motion block yet: the next one is approached
  };
  [[nodiscard]] Junction junction() const noexcept;
  /// Goes on at rest from where another planner brought the machine, within rounding of a pose that
  /// junction() would tell. Only where no block waits for room.
  void continue_at(const Junction& junction) noexcept;

  /// Rewinds off the part, where the tool rests, to the best winding or branch that `trial` lets
  /// pass: in `block` a joint would come to `end`, outside travel. Refused where none does, or
  /// where the tool cannot leave the part. kNoRoom as for plan().
  [[nodiscard]] PlanResult rewind(const ClBlock& block, const TravelEnd& end,
                                  const RewindTrial& trial, MotionWriter& writer) noexcept;

  /// Joints and tool length at the end of what was published.
  [[nodiscard]] const JointVector& joints() const noexcept;
  [[nodiscard]] double tool_length_mm() const noexcept;

 private:
  [[nodiscard]] PlanResult publish(MotionWriter& writer) noexcept;

  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace meridian
