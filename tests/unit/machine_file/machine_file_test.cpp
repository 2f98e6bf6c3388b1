// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/machine_file.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/machine/file/sections/homing_file.hpp"
#include "support/machines.hpp"
#include "support/text_file.hpp"

namespace meridian::config {
namespace {

const std::filesystem::path kMachines = MERIDIAN_SOURCE_DIR "/deploy/machines";

TEST(MachineFile, GivesTheConstantsOfTheLaiMachine) {
  const MachineModel model = load_machine(kMachines / "lai.toml");
  EXPECT_EQ(model.name, "lai");
  EXPECT_EQ(model.lai.pivot_mm + model.tool_length_mm, 250);
  EXPECT_EQ(model.lai.e_mm, 60);
  EXPECT_EQ(model.lai.h_mm, 400);
  EXPECT_EQ(model.cycle_ns, 1'000'000);
  EXPECT_FALSE(model.default_unit_mm || model.default_unit_inch);
  EXPECT_DOUBLE_EQ(model.max_feed_mm_per_s, 500);
  EXPECT_DOUBLE_EQ(model.tolerances.axis_rad, units::rad_from_deg(0.1));
  EXPECT_EQ(model.pole_policy, PolePolicy::kRelax);
  EXPECT_EQ(model.override_ramp_s, 1);
  EXPECT_EQ(model.X_MW.rotation, Eigen::Matrix3d::Identity());
}

TEST(MachineFile, GivesJointsInMachineOrderAndHouseUnits) {
  const MachineModel model = load_machine(kMachines / "lai.toml");
  ASSERT_EQ(model.joint_count, 5);
  const char* const names[] = {"b3", "b2", "b4", "theta1", "theta2"};
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(model.joints[i].name, names[i]);
    EXPECT_EQ(model.joints[i].is_rotary, i >= 3);
    EXPECT_FALSE(model.joints[i].is_endless);
  }
  EXPECT_EQ(model.joints[2].limits.travel_min, -500);
  EXPECT_EQ(model.joints[0].limits.jerk, 60000);
  EXPECT_DOUBLE_EQ(model.joints[3].limits.travel_max, 4 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(model.joints[4].limits.travel_max, std::numbers::pi / 3);
  EXPECT_DOUBLE_EQ(model.joints[4].limits.velocity, std::numbers::pi / 3);
  EXPECT_DOUBLE_EQ(model.joints[4].limits.fault_jerk, units::rad_from_deg(48000));
  EXPECT_DOUBLE_EQ(model.joints[3].limits.following_error, units::rad_from_deg(2));
}

TEST(MachineFile, RunsOnThroughBlocksWhereItDoesNotAskForExactStop) {
  std::string text = test::read_text(kMachines / "lai.toml");
  const auto begin = text.find("transition = ");
  ASSERT_NE(begin, std::string::npos);
  EXPECT_EQ(parse_machine(text, "lai.toml").transition, Transition::kSmooth);
  text.erase(begin, text.find('\n', begin) + 1 - begin);
  EXPECT_EQ(parse_machine(text, "lai.toml").transition, Transition::kSmooth);
  text.insert(begin, "transition = \"exact_stop\"\n");
  EXPECT_EQ(parse_machine(text, "lai.toml").transition, Transition::kExactStop);
}

TEST(MachineFile, OfTheBenchEqualsTheMachineOfTheTests) {
  const MachineModel file = load_machine(kMachines / "bench.toml");
  const MachineModel made = test::bench_machine();
  EXPECT_EQ(file.lai.pivot_mm, made.lai.pivot_mm);
  EXPECT_EQ(file.lai.e_mm, made.lai.e_mm);
  EXPECT_EQ(file.lai.h_mm, made.lai.h_mm);
  EXPECT_EQ(file.tool_length_mm, made.tool_length_mm);
  for (int i = 0; i < 5; ++i) {
    const JointLimits &a = file.joints[i].limits, &b = made.joints[i].limits;
    EXPECT_EQ(file.joints[i].is_endless, made.joints[i].is_endless);
    EXPECT_DOUBLE_EQ(a.velocity, b.velocity);
    EXPECT_DOUBLE_EQ(a.acceleration, b.acceleration);
    EXPECT_DOUBLE_EQ(a.jerk, b.jerk);
    EXPECT_DOUBLE_EQ(a.fault_jerk, b.fault_jerk);
    EXPECT_DOUBLE_EQ(a.following_error, b.following_error);
    if (!file.joints[i].is_endless) {
      EXPECT_DOUBLE_EQ(a.travel_max, b.travel_max);
    }
  }
}

TEST(MachineFile, EveryShippedMachineLoads) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kMachines)) {
    SCOPED_TRACE(entry.path());
    const MachineModel model = load_machine(entry.path());
    EXPECT_EQ(model.name, entry.path().stem());
    ++count;
  }
  EXPECT_GE(count, 2);
}

TEST(MachineFile, GivesTheStageOfTheHybridMachine) {
  const MachineModel model = load_machine(kMachines / "lai-hybrid.toml");
  ASSERT_TRUE(has_stage(model));
  EXPECT_EQ(model.stage.kind, StageKind::kTwoSlider);
  EXPECT_EQ(model.stage.linear_joint, 1);
  EXPECT_EQ(model.stage.rotary_joint, 3);
  EXPECT_EQ(model.stage.sign_s, -1);
  EXPECT_EQ(model.stage.sign_phi, -1);
  EXPECT_EQ(model.stage.offset_s_mm, 60);
  EXPECT_EQ(model.stage.side1, 1);
  EXPECT_EQ(model.stage.side2, 1);
  EXPECT_DOUBLE_EQ(model.stage.phi_max_rad, std::numbers::pi / 3);
  EXPECT_EQ(limited_spec(model, 5).name, "u1");
  EXPECT_EQ(limited_spec(model, 6).limits.jerk, 80000);
  EXPECT_FALSE(limited_spec(model, 6).is_rotary);
  EXPECT_DOUBLE_EQ(model.stage_drives[0].home, -300) << "s = 0, φ = 0, d = 0: the rod's length";
}

TEST(MachineFile, HasNoStageWhereNoneIsDescribedOrEveryJointHasItsDrive) {
  EXPECT_FALSE(has_stage(load_machine(kMachines / "lai.toml")));
  const std::string text = test::read_text(kMachines / "lai.toml");
  EXPECT_FALSE(has_stage(parse_machine(text + "\n[stage]\nkind = \"identity\"\n", "identity")));
}

TEST(MachineFile, TakesAPinSlotWithoutRods) {
  std::string text = test::read_text(kMachines / "lai-hybrid.toml");
  const auto put = [&text](std::string_view from, std::string_view to) {
    text.replace(text.find(from), from.size(), to);
  };
  put("kind = \"trailing\"", "kind = \"pin-slot\"");
  put("radius_mm = 150", "#");
  put("rod_mm = 300", "#");
  put("rods = \"ahead\"", "#");
  const MachineModel model = parse_machine(text, "pin-slot");
  EXPECT_EQ(model.stage.kind, StageKind::kPinSlot);
  EXPECT_EQ(model.stage.rail_mm, 150);
  EXPECT_NEAR(model.stage_drives[0].home, 0, 1e-12);
}

TEST(MachineFile, TakesTolerancesFinerThanSmoothRunsHaveWhereItsCutsEndAtRest) {
  std::string text = test::read_text(MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml");
  const std::string_view tip = "tip_mm = 0.01\n", axis = "axis_deg = 0.1\n";
  text.replace(text.find(tip), tip.size(), "tip_mm = 0.0005\n");
  text.replace(text.find(axis), axis.size(), "axis_deg = 0.001\n");
  EXPECT_THROW((void)parse_machine(text, "fine"), ConfigError);
  const std::string_view smooth = "transition = \"smooth\"";
  text.replace(text.find(smooth), smooth.size(), "transition = \"exact_stop\"");
  const MachineModel model = parse_machine(text, "fine");
  EXPECT_EQ(model.tolerances.tip_mm, 0.0005);
  EXPECT_DOUBLE_EQ(model.tolerances.axis_rad, units::rad_from_deg(0.001));
}

TEST(MachineFile, TakesThePolesPolicyAndTheOverridesRamp) {
  std::string text = test::read_text(kMachines / "lai.toml");
  const auto put = [&text](std::string_view from, std::string_view to) {
    text.replace(text.find(from), from.size(), to);
  };
  put("policy = \"ease\"", "policy = \"exact\"");
  put("[machine]\n", "[machine]\noverride_ramp_s = 20\n");
  const MachineModel model = parse_machine(text, "exact");
  EXPECT_EQ(model.pole_policy, PolePolicy::kExact);
  EXPECT_EQ(model.override_ramp_s, 20);
  EXPECT_EQ(model.max_feed_override, 1.5) << "unless the file says otherwise";
  put("[machine]\n", "[machine]\nfeed_override_max_percent = 120\n");
  EXPECT_EQ(parse_machine(text, "120").max_feed_override, 1.2);
  put("= 120", "= 99");
  EXPECT_THROW((void)parse_machine(text, "99"), std::runtime_error);
}

TEST(MachineFile, TakesHowTheRedundantJointIsTurnedBack) {
  std::string text = test::read_text(kMachines / "lai.toml");
  EXPECT_EQ(parse_machine(text, "as it ships").rewind_policy, RewindPolicy::kRefuse);
  const std::string_view refuse = "policy = \"refuse\"";
  text.replace(text.find(refuse), refuse.size(), "policy = \"retract\"\nretract_mm = 75");
  const MachineModel model = parse_machine(text, "retract");
  EXPECT_EQ(model.rewind_policy, RewindPolicy::kRetract);
  EXPECT_EQ(model.rewind_retract_mm, 75);
}

TEST(MachineFile, SaysInWhichOrderAndHowLongJointsHome) {
  const std::string text = test::read_text(kMachines / "lai.toml");
  const HomingConfig plain = load_homing(kMachines / "lai.toml", 5);
  EXPECT_EQ(plain.timeout_s, 60);
  EXPECT_EQ(plain.turns[0], 0);
  const test::TextFile file(text + "\n[homing]\norder = [2, 2, 1, 3, 3]\ntimeout_s = 7.5\n");
  const HomingConfig homing = load_homing(file.path(), load_machine(file.path()).joint_count);
  EXPECT_EQ(homing.timeout_s, 7.5);
  EXPECT_EQ(homing.turns, (std::array<int, kMaxJoints>{2, 2, 1, 3, 3, 0}));
  for (const char* wrong : {"order = [1, 2, 3]", "order = [1, 2, 3, 4, 7]",
                            "order = [1, 2, 3, 4, 1.5]", "timeout_s = 0", "turns = 3"}) {
    EXPECT_THROW((void)parse_machine(text + "\n[homing]\n" + wrong + "\n", wrong),
                 std::runtime_error)
        << wrong;
  }
}

TEST(MachineFile, TakesFrameUnitAndCycleTime) {
  std::string text = test::read_text(kMachines / "lai.toml");
  const auto put = [&text](std::string_view from, std::string_view to) {
    text.replace(text.find(from), from.size(), to);
  };
  put("origin_mm = [0, 0, 0]", "origin_mm = [1, 2.5, -3]");
  put("rotation_deg = [0, 0, 0]", "rotation_deg = [0, 0, 90]");
  put("default_unit = \"none\"", "default_unit = \"inch\"");
  put("cycle_us = 1000", "cycle_us = 125");
  const test::TextFile file(text);
  const MachineModel model = load_machine(file.path());
  EXPECT_EQ(model.X_MW.origin_mm, Vector3(1, 2.5, -3));
  EXPECT_EQ(model.X_MW.rotation * Vector3(1, 0, 0), Vector3(0, 1, 0));
  EXPECT_TRUE(model.default_unit_inch);
  EXPECT_EQ(model.cycle_ns, 125'000);
}

}  // namespace
}  // namespace meridian::config
