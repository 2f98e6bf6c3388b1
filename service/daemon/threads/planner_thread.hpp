// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "meridian/planner/smooth_planner.hpp"
#include "service/daemon/ports/ports.hpp"
#include "service/daemon/ports/queue_follower.hpp"

namespace meridian::interpolator {

/// Plans block by block into the motion port. A plan begins where the machine rests in Ready, in
/// the epoch of that moment; when the cycle advances the epoch, the plan and all blocks that came
/// in before intake took note of it are void. What it publishes depends on the blocks and that
/// beginning alone, never on the clock, unless the stream stalls for a second at the begin of a
/// program, and on what Ports::feed_marks holds. Preallocated.
class PlannerThread {
 public:
  PlannerThread(const MachineModel& model, const ToolTable& tools, Ports& ports);

  /// Before run(): where the workpiece lies, and with which tools it is cut.
  void set_up(const SetUpInForce& in_force, ToolTable tools) noexcept {
    apply_set_up(model_, in_force);
    planner_.swap_tools(tools);
  }
  /// Runs until Ports::is_stopping.
  void run() noexcept;

 private:
  /// Does one piece of work; false if there is none (yet).
  [[nodiscard]] bool work() noexcept;
  [[nodiscard]] bool plan(const QueuedBlock& queued) noexcept;
  void refuse(const BlockReject& reject) noexcept;
  /// What others want to know of what was planned.
  void report_plan() noexcept;
  /// How the program is approached; of one that begins nothing is known yet.
  void report(const Approach& approach) noexcept;
  /// Goes on with what is there while no block comes.
  void advance() noexcept;
  /// A program of which no block has come for a while begins with those that are there.
  void look_at_stall() noexcept;
  [[nodiscard]] bool announce_action(const ClBlock& block) noexcept;
  void pop() noexcept;

  Ports& ports_;
  QueueFollower queue_;
  MotionWriter writer_;
  MachineModel model_;
  SmoothPlanner planner_;
  ToolTable spare_tools_;           ///< what the planner had before; the commands thread frees it
  std::uint64_t session_ = 0;       ///< of the block that was planned last
  std::int64_t last_block_ns_ = 0;  ///< when one was planned last
  std::uint64_t look_ = 0;          ///< SmoothPlanner::look() when last asked
  std::int64_t looking_since_ns_ = 0;  ///< it waits for blocks
  std::int64_t planning_ns_ = 0;     ///< spent on the block in hand, attempts without room included
  double published_before_s_ = 0;    ///< when the plan was begun
  bool has_begun_ = false;           ///< a plan is being made
  bool is_refused_ = false;          ///< a block was refused: nothing behind it moves
  bool is_action_reported_ = false;  ///< of the block at the head of the queue
  trace::SpanWriter spans_;
};

}  // namespace meridian::interpolator
