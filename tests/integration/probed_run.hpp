// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

#include "meridian/cycle/step.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/analysis/simulate/block_feed.hpp"
#include "service/drives/simulated/probed_part.hpp"
#include "service/drives/simulated/servo.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/protocol/operator/move_program.hpp"

namespace meridian::test {

/// What a probing move found. Frame: that of the machine's workpiece.
struct FoundTouch {
  bool is_found = false;
  JointVector joints{};       ///< latched
  JointVector free_joints{};  ///< in the report before
  std::uint64_t periods = 0;
  double lag_mm = 0;  ///< from the latched tip to the setpoint of the cycle before
  Vector3 tip = Vector3::Zero(), rest_tip = Vector3::Zero();  ///< latched, and at rest by setpoints
  double uncertainty_mm = 0;
};

/// A probing move through check, planner, cycle and servos that lag, in process: the world that the
/// service and simulated drives are to one another, without a wire.
class ProbedRun {
 public:
  ProbedRun(const stream::StraightMove& move, const MachineModel& machine, const JointVector& at,
            const drives::ServoLag& lag, const drives::ProbedPart& part)
      : machine_(machine),
        text_(program_of(move)),
        reader_(std::string_view(text_), "probe"),
        port_(std::make_unique<MotionPort>()),
        motion_(*port_),
        feed_(reader_, machine_, {}, *port_, true, nullptr),
        state_({}, rate_bounds(machine_)),
        lag_(lag),
        probe_(part, machine_) {
    const JointVector drives = has_stage(machine) ? drives_of(machine, at) : at;
    for (std::size_t i = 0; i < drives.size(); ++i) servos_[i] = {drives[i], 0};
    in_.session = 1;
  }

  [[nodiscard]] FoundTouch go() {
    run();
    command(Verb::kEnable);
    while (state_.state != State::kReady) run();
    SmoothSettings settings;
    settings.transition = Transition::kExactStop;
    settings.ends_exactly = true;
    feed_.begin(out_.record.joints, state_.epoch, settings);
    while (state_.state != State::kLoaded) run();
    command(Verb::kStart, kStartProbing);
    while (is_on_path(state_.state)) run();
    found_.rest_tip = tip_of(out_.record.joints);
    return found_;
  }

 private:
  void command(Verb verb, double argument = 0) {
    in_.has_command = true;
    in_.command = {++request_, verb, argument};
    run();
    in_.has_command = false;
  }

  void run() {
    if (feed_.has_begun()) feed_.fill();
    ++in_.cycle;
    in_.due_ns = in_.now_ns = static_cast<std::int64_t>(in_.cycle) * machine_.cycle_ns;
    report();
    const JointVector before = out_.record.joints;
    step(machine_, state_, motion_, in_, out_);
    keep_contact(before);
    for (std::size_t i = 0; i < servos_.size(); ++i) {
      const double dt_s = 1e-9 * static_cast<double>(machine_.cycle_ns);
      servos_[i] = drives::follow(servos_[i], out_.record.setpoint.position[i], dt_s, lag_);
    }
  }

  void report() {
    const std::uint32_t all = all_joints(machine_);
    Feedback& f = in_.feedback;
    for (std::size_t i = 0; i < servos_.size(); ++i) f.position[i] = servos_[i].position;
    f.arrival_ns = in_.now_ns;
    f.cycle_seen = in_.cycle - 1;
    f.joint_mask = f.referenced_mask = all;
    f.enabled_mask = is_enabled(state_.state) ? all : 0;
    f.probe = probe_.distance(f.position) > 0 ? ProbeInput::kFree : ProbeInput::kContact;
  }

  void keep_contact(const JointVector& setpoint) {
    for (std::size_t n = 0; n < out_.event_count; ++n) {
      const Event& event = out_.events[n];
      if (event.code == EventCode::kContactJoint) {
        (event.b == 0 ? found_.joints : found_.free_joints)[event.a] = event.x;
      }
      if (event.code != EventCode::kContactFound) continue;
      found_.is_found = true;
      found_.periods = event.a;
      found_.tip = tip_of(found_.joints);
      found_.uncertainty_mm = (found_.tip - tip_of(found_.free_joints)).norm();
      found_.lag_mm = (tip_of(setpoint) - found_.tip).norm();
    }
  }

  [[nodiscard]] Vector3 tip_of(const JointVector& joints) const {
    return forward(machine_, machine_.tool_length_mm, joints).tip;
  }

  MachineModel machine_;
  std::string text_;
  cl::ClReader reader_;
  std::unique_ptr<MotionPort> port_;
  MotionReader motion_;
  simulate::BlockFeed feed_;
  CycleState state_;
  CycleInputs in_;
  StepOutput out_;
  drives::ServoLag lag_;
  drives::SimulatedProbe probe_;
  std::array<drives::ServoState, kMaxJoints> servos_{};
  FoundTouch found_;
  std::uint64_t request_ = 0;
};

}  // namespace meridian::test
