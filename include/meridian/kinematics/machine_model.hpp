// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>

#include "meridian/geometry/rigid_transform.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/chain_kinematics.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/keep_out.hpp"
#include "meridian/kinematics/lai.hpp"
#include "meridian/kinematics/robot.hpp"
#include "meridian/kinematics/stage.hpp"
#include "meridian/kinematics/tip_box.hpp"

namespace meridian {

/// What a joint may do. Units: mm or rad, and s.
struct JointLimits {
  double travel_min = 0, travel_max = 0;  ///< ignored where `is_endless`
  double velocity = 0, acceleration = 0, jerk = 0;
  double fault_acceleration = 0, fault_jerk = 0;  ///< FaultStop
  double following_error = 0;  ///< largest |setpoint - feedback| before FaultStop
};

struct JointSpec {
  std::string name;  ///< column of a recording is name_mm or name_rad
  /// Address in NC programs, "-" before it where the controller counts against the joint; empty:
  /// the name is the address.
  std::string nc_word;
  bool is_rotary = false;
  bool is_endless = false;
  double home = 0;
  JointLimits limits;
};

/// Which closed forms a machine has. The one of its own in MachineModel is filled, the others rest.
enum class MachineFamily : std::uint8_t {
  kLai,    ///< the machine of Lai et al. by its Denavit-Hartenberg table
  kChain,  ///< any chain of three linear and two rotary joints
  kRobot   ///< articulated, 5R or 6R
};

/// What the planner does beside the pole of the free rotary joint. Where the azimuth differs on
/// leaving the pole itself, the redundant joint turns at rest, tip and axis fixed, whatever the
/// policy.
enum class PolePolicy : std::uint8_t {
  kRelax,  ///< the redundant joint may take a shorter way that moves the axis inside its tolerance
  kExact   ///< the joints follow the path, which slows down as the redundant joint needs it
};

/// What the planner does where a joint would leave its travel within the program that another
/// winding or branch keeps inside. Where tip and axis rest on the pole the redundant joint turns in
/// place whatever the policy.
enum class RewindPolicy : std::uint8_t {
  kRefuse,  ///< the block is refused
  kRetract  ///< rest, off the part along the tool axis, whole turns of the redundant joint or over
            ///< the pole to the other branch, back, on
};

/// How the cuts of a program join.
enum class Transition : std::uint8_t {
  kExactStop,  ///< rest at the end of every block
  kSmooth      ///< on through blocks, corners rounded inside the tolerances
};

/// Least tolerances that smooth runs are planned for: every edge refuses less where a run is
/// smooth.
inline constexpr double kMinTipTolerance_mm = 1e-3;
inline constexpr double kMinAxisTolerance_rad = 1e-4;
/// Largest that may be asked for, 10 mm and 10 degrees: every edge refuses more.
inline constexpr double kMaxTipTolerance_mm = 10;
inline constexpr double kMaxAxisTolerance_rad = 0.17453292519943295;

/// Deviation that smoothing and relaxing at the pole may use together, measured from the programmed
/// path.
struct Tolerances {
  double tip_mm = 0.01;
  double axis_rad = 0.0017453292519943296;
  double pole_axis_rad = 0;  ///< within kPoleReach_rad of the pole in place of axis_rad, if larger

  /// The larger of both axis tolerances.
  [[nodiscard]] double axis_beside_pole_rad() const noexcept {
    return pole_axis_rad > axis_rad ? pole_axis_rad : axis_rad;
  }
};

/// Farther from the pole than this the redundant joint is never relaxed.
inline constexpr double kPoleReach_rad = 0.4;

/// Everything that is known about a machine before it moves: built and checked once by
/// config::load_machine, immutable after. Rotation of the workpiece frame is orthonormal.
struct MachineModel {
  std::string name;
  std::string version;
  MachineFamily family = MachineFamily::kLai;
  LaiKinematics lai;
  ChainKinematics chain;
  RobotKinematics robot;
  int joint_count = 5;
  std::array<JointSpec, kMaxJoints> joints;
  ActuatorStage stage;  ///< between two of the joints and their drives; identity: none
  std::array<JointSpec, kStageDrives> stage_drives;  ///< its sliders u1, u2 (linear)
  KeepOut keep_out;                                  ///< where the joints may not stand together
  TipBox tip_box;             ///< what the tool tip stays inside of, over the base
  double tool_length_mm = 0;  ///< tool in the spindle when the service starts
  RigidTransform X_MW;        ///< workpiece W in the frame M of the kinematics
  Tolerances tolerances;
  Transition transition = Transition::kExactStop;  ///< of programs that do not ask for another
  PolePolicy pole_policy = PolePolicy::kRelax;
  RewindPolicy rewind_policy = RewindPolicy::kRefuse;
  double rewind_retract_mm = 0;  ///< kRetract: the whole way off the part, never less
  double clearance_mm = 50;      ///< retract of an approach along the tool axis
  double approach_feed_mm_per_s = 10;
  double max_feed_mm_per_s = 0;  ///< programmed feeds above it are limited and reported
  std::int64_t cycle_ns = 1'000'000;
  bool default_unit_mm = false;  ///< unitless CL files are taken as millimetre
  bool default_unit_inch = false;
  double starve_auto_resume_s = 2.0;
  int bridge_cycles = 3;  ///< lost periods that the drives bridge
  /// Least time that the feed override, a resume or a hold along the plan takes between 100 % and
  /// 0, s. Every plan keeps room in the joints' limits for it; the longer, the less.
  double override_ramp_s = 1.0;
  /// Highest feed override, at least 1. Above 1 later motion is planned for a higher feed.
  double max_feed_override = 1.0;
  /// The chain's directions and points are measured: what is a little off is meant.
  bool is_measured = false;
};

/// Deviation of the axis that is allowed within kPoleReach_rad of the pole.
[[nodiscard]] inline double axis_tolerance_beside_pole(const MachineModel& model) noexcept {
  return model.pole_policy == PolePolicy::kExact ? model.tolerances.axis_rad
                                                 : model.tolerances.axis_beside_pole_rad();
}

}  // namespace meridian
