// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"

/// Machines for tests of the core, which knows no files.
namespace meridian::test {

/// The Lai machine of the benchmark paths: l = 200 mm, e = 0, h = 400 mm, endless C, travel that
/// never gets in the way; 300 mm/s, 3000 mm/s², 60000 mm/s³ and 60 deg/s, 600 deg/s², 12000 deg/s³.
[[nodiscard]] inline MachineModel bench_machine() {
  MachineModel model;
  model.name = "bench";
  model.lai = {.pivot_mm = 100, .e_mm = 0, .h_mm = 400};
  model.tool_length_mm = 100;
  const char* const names[] = {"b3", "b2", "b4", "theta1", "theta2"};
  for (int i = 0; i < 5; ++i) {
    JointSpec& joint = model.joints[i];
    joint.name = names[i];
    joint.is_rotary = i >= 3;
    joint.is_endless = i == 3;
    const double unit = joint.is_rotary ? units::kDegree_rad : 1.0;
    const double scale = joint.is_rotary ? 60 * unit : 300;
    joint.limits.travel_min = joint.is_rotary ? -std::numbers::pi : -2000;
    joint.limits.travel_max = -joint.limits.travel_min;
    joint.limits.velocity = scale;
    joint.limits.acceleration = 10 * scale;
    joint.limits.jerk = 200 * scale;
    joint.limits.fault_acceleration = 20 * scale;
    joint.limits.fault_jerk = 800 * scale;
    joint.limits.following_error = joint.is_rotary ? 2 * unit : 5;
  }
  model.max_feed_mm_per_s = 1000;
  return model;
}

/// A Lai machine with an offset: l = 250 mm, e = 60 mm, h = 400 mm, tilt ±60°, C two turns each
/// way, limits as bench_machine().
[[nodiscard]] inline MachineModel lai_machine() {
  MachineModel model = bench_machine();
  model.name = "lai";
  model.lai = {.pivot_mm = 140, .e_mm = 60, .h_mm = 400};
  model.tool_length_mm = 110;
  for (int i = 0; i < 3; ++i) {
    model.joints[i].limits.travel_min = -600;
    model.joints[i].limits.travel_max = 600;
  }
  model.joints[3].is_endless = false;
  model.joints[3].limits.travel_min = -4 * std::numbers::pi;
  model.joints[3].limits.travel_max = 4 * std::numbers::pi;
  model.joints[4].limits.travel_min = units::rad_from_deg(-60);
  model.joints[4].limits.travel_max = units::rad_from_deg(60);
  return model;
}

/// Two trailing sliders that carry slide b2 and table theta1 of the Lai machine.
[[nodiscard]] inline ActuatorStage trailing_stage(double phi_max_rad) {
  ActuatorStage stage;
  stage.kind = StageKind::kTwoSlider;
  stage.linear_joint = 1;
  stage.rotary_joint = 3;
  stage.sign_s = -1;
  stage.sign_phi = -1;
  stage.radius_mm = 150;
  stage.rail_mm = 150;
  stage.rod_mm = 300;
  stage.phi_max_rad = phi_max_rad;
  return stage;
}

/// lai_machine() with two sliders that carry slide b2 and table theta1, which turns 60° either way.
/// The table carries the workpiece, so slide and turn of the stage run against the joints.
[[nodiscard]] inline MachineModel hybrid_machine() {
  MachineModel model = lai_machine();
  model.name = "lai-hybrid";
  model.stage = trailing_stage(units::rad_from_deg(60));
  model.joints[3].limits.travel_min = units::rad_from_deg(-60);
  model.joints[3].limits.travel_max = units::rad_from_deg(60);
  for (std::size_t i = 0; i < kStageDrives; ++i) {
    model.stage_drives[i] = model.joints[1];
    model.stage_drives[i].name = i == 0 ? "u1" : "u2";
    model.stage_drives[i].limits.travel_min = -900;
    model.stage_drives[i].limits.travel_max = 400;
  }
  const JointVector home = drives_of(model, JointVector{});
  model.stage_drives[0].home = home[1];
  model.stage_drives[1].home = home[3];
  return model;
}

}  // namespace meridian::test
