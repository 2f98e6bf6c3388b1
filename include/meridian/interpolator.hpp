// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "meridian/path/cl_block.hpp"

/// The library for another control: blocks in, setpoints out. docs/embed.md is the tutorial.
namespace meridian {

/// What the machine does after a cycle. The setpoint is valid with every status.
enum class Status : std::uint8_t {
  kReady,    ///< at rest; nothing was started, or the start was refused
  kRunning,  ///< a program runs, or comes to rest; call update() in every period
  kHeld,     ///< at rest on the path after hold(); resume() goes on
  kStarved,  ///< at rest on the path: blocks are missing; push() goes on
  kDone,     ///< at rest at the end of the program
  kStopped,  ///< at rest after abort()
  kFault     ///< at rest after a fault: alarm() says which; this interpolator is used up
};

/// Planner and cycle of the service as one object, without threads, clock, files and DDS: the same
/// code computes the same setpoints bit for bit.
///
/// Two threads may share it. One calls push(), plan(), begin() and the operator's functions; these
/// allocate and plan. The other calls update() once per period. Everything starts from drives that
/// are on, referenced and at rest. Units: mm, rad, s.
/// Proof: tests/unit/embed/interpolator_test.cpp.
class Interpolator {
 public:
  /// `model` is checked, as load_machine() returns it; it is copied. The drives stand at home.
  explicit Interpolator(const MachineModel& model, const ToolTable& tools = {});
  /// The drives stand at `drives`, drive coordinates. The first update() compares this with the
  /// feedback; a machine that stands elsewhere faults and does not move.
  Interpolator(const MachineModel& model, const ToolTable& tools, const JointVector& drives);
  ~Interpolator();
  Interpolator(const Interpolator&) = delete;
  Interpolator& operator=(const Interpolator&) = delete;

  /// Checks a block, keeps it, and plans as far as there is room. The last block of a program is of
  /// kind kEnd. Blocks of actions (spindle, coolant, tool, stop) are refused: do them between
  /// programs. The error is one sentence with line, reason and range: nothing of the block moves,
  /// and no later block is accepted until begin().
  [[nodiscard]] Expected<void, std::string> push(const ClBlock& block);

  /// Plans what was pushed and found no room. A program that is longer than the room (some thousand
  /// blocks) needs it now and then while it runs. Returns the reason if a block cannot be planned.
  [[nodiscard]] Expected<void, std::string> plan();

  /// Opens the next program. An error if the last update() did not return kDone or kStopped.
  [[nodiscard]] Expected<void, std::string> begin();

  /// The operator. False if too many requests wait for update(). The cycle refuses what does not
  /// fit its state, as the service does.
  bool start() noexcept;
  bool hold() noexcept;
  bool resume() noexcept;
  bool abort() noexcept;
  /// 1 is 100 %; at most MachineModel::max_feed_override. Above 100 % it raises the feed of what
  /// is not planned yet.
  bool set_feed_override(double factor) noexcept;

  /// Computes the setpoint of the next period. `feedback`: what the drives reported since the last
  /// call; `joint_mask` 0 if nothing came. Its times are set here. `lost_periods`: periods without
  /// a call before this one. RT: cycle; no allocation, lock or system call.
  [[nodiscard]] Status update(const Feedback& feedback, Setpoint& setpoint,
                              std::uint32_t lost_periods = 0) noexcept;

  /// Why the machine is in kFault. RT: cycle.
  [[nodiscard]] Alarm alarm() const noexcept;
  /// Everything about the last cycle. RT: cycle.
  [[nodiscard]] const CycleRecord& record() const noexcept;

 private:
  class Machine;
  std::unique_ptr<Machine> machine_;
};

/// The feedback of ideal drives that follow `setpoint` at once: for simulations and tests.
[[nodiscard]] Feedback ideal_feedback(const MachineModel& model, const Setpoint& setpoint) noexcept;

/// The first feedback of ideal drives at home.
[[nodiscard]] Feedback ideal_feedback(const MachineModel& model) noexcept;

}  // namespace meridian
