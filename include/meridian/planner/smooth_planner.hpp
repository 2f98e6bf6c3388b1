// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "meridian/path/cl_block.hpp"
#include "meridian/planner/approach.hpp"
#include "meridian/planner/feed_mark.hpp"
#include "meridian/planner/motion_port.hpp"
#include "meridian/planner/relaxed_axis.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "meridian/planner/rewind.hpp"

namespace meridian {

/// What a program may ask for instead of what the machine's file says. Tolerances are at least
/// kMinTipTolerance_mm and kMinAxisTolerance_rad; less, which no edge lets into a
/// smooth run, counts as these.
struct SmoothSettings {
  std::optional<Transition> transition;
  double tip_tolerance_mm = 0;                ///< 0: the machine's
  double axis_tolerance_rad = 0;              ///< 0: the machine's
  bool retracts_first = false;                ///< as RestToRestPlanner::begin() says
  std::optional<JointVector> first_joints{};  ///< the same
  bool ends_exactly = false;  ///< exact stop: on the programmed axis, be it beside the pole
};

/// The planner that runs on through blocks: cuts become a band spline, the rolling feed moves along
/// it in windows that each end in a stop of their own. Everything else is left to the plain planner
/// and done at rest: approach, rapids, dwells, actions, stops, blocks that lead off the pole from
/// rest. Through and past the pole, and lingering there, the redundant joint may relax the axis
/// inside its tolerance (docs/motion.md, section 10).
///
/// A cut that was taken (kOk) is published when enough of what follows it is known: up to 172 mm
/// of path and half a second of motion later, or when a block comes that is done at rest. What is
/// published depends on the blocks and begin() alone, as long as the machine does not run dry; it
/// then goes on from where it came to rest. Fixed store, no clock.
///
/// What is taken up while the operator asks for more than 100 % (MotionWriter::feed_override()) is
/// planned for that much of the programmed feed, up to MachineModel::max_feed_override; joints and
/// the machine's highest feed bound it as always. take_feed_mark() tells from where on, and with
/// replay_feed() the plan is the same again.
///
/// A machine with a redundant joint: branch and winding at the begin of a program are those that
/// carry farthest through the first kLookAhead blocks, which are therefore taken before anything is
/// published (fewer where the program ends, or look_no_further() is called). So are those behind
/// every place beside the pole where cuts run on: where more than one way carries through what is
/// there, as many blocks are taken before the place is planned. Where the redundant joint
/// runs out of travel all the same, the machine rests, in mid-block where cuts run on, and the
/// joint is turned back off the part if the machine's file says how (docs/motion.md, section 11).
///
/// A refusal may name a block that was taken before; what is published ends at rest ahead of it.
/// Method and formulas: docs/motion.md. Context: planner thread.
/// Proof: tests/property/planner/smooth_planner_test.cpp.
class SmoothPlanner {
 public:
  static constexpr std::size_t kLookAhead = 2048;

  explicit SmoothPlanner(const MachineModel& model, ToolTable tools = {});
  ~SmoothPlanner();
  SmoothPlanner(const SmoothPlanner&) = delete;
  SmoothPlanner& operator=(const SmoothPlanner&) = delete;

  /// As RestToRestPlanner::swap_tools().
  void swap_tools(ToolTable& tools) noexcept;

  /// As RestToRestPlanner::begin().
  void begin(const JointVector& at_rest, double tool_length_mm, std::uint16_t epoch,
             const SmoothSettings& settings = {}) noexcept;

  /// Takes one block and publishes what has become ready. kNoRoom: the block was not taken, call
  /// again with the same one.
  [[nodiscard]] PlanResult plan(const ClBlock& block, MotionWriter& writer) noexcept;

  /// Publishes what is ready, without a new block: where the port was full, or the machine ran dry
  /// and has to be sent on. kRefused, with the block: found on the way, told again by plan(); else
  /// kOk.
  [[nodiscard]] PlanResult advance(MotionWriter& writer) noexcept;

  /// Not 0: something is not planned because blocks are missing that are only looked at; a number
  /// for every such look.
  [[nodiscard]] std::uint64_t look() const noexcept;
  /// No block comes for a while: the program begins, or goes on past the pole, with those that are
  /// there.
  void look_no_further() noexcept;

  /// No block comes any more until begin(), and no end: advance() publishes what was taken, to its
  /// end, at rest.
  void finish() noexcept;

  /// Takes the approach of the program, once, when it is published; false: not by now.
  [[nodiscard]] bool take_approach(Approach& out) noexcept;

  /// Takes the oldest rewind of what was planned so far; false if there is none. At most 256
  /// wait, then the oldest go.
  [[nodiscard]] bool take_rewind(Rewind& out) noexcept;

  /// Takes the oldest stretch beside the pole on which the axis was moved, of what was planned so
  /// far; false if there is none. At most 256 wait, then the oldest go.
  [[nodiscard]] bool take_relaxed_axis(RelaxedAxis& out) noexcept;

  /// Takes the oldest mark of where a feed override above 100 % holds from, or of how much was
  /// looked at, of what was planned so far; false if there is none. A program's begin comes first.
  /// At most 256 wait, then the oldest go.
  [[nodiscard]] bool take_feed_mark(FeedMark& out) noexcept;

  /// Before begin(): plans with the factors of an earlier run of the program, not with what the
  /// operator asks for, and looks at as many blocks as it did. `marks` are those of that program,
  /// in order, and must stay.
  void replay_feed(std::span<const FeedMark> marks) noexcept;

  /// Joints and tool length at the end of the last motion that was published to its end.
  [[nodiscard]] const JointVector& joints() const noexcept;
  [[nodiscard]] double tool_length_mm() const noexcept;

 private:
  [[nodiscard]] PlanResult plan_one(const ClBlock& block, MotionWriter& writer) noexcept;
  /// Plans what was taken to look at; false: not all of it yet, or a block was refused.
  [[nodiscard]] bool plan_what_waits(MotionWriter& writer) noexcept;

  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace meridian
