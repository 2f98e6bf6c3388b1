// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <random>
#include <sstream>

#include "meridian/units.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/inspect/inspection.hpp"
#include "service/machine/inspect/joint_pattern.hpp"
#include "service/machine/inspect/picture/skeleton.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "support/shipped_machines.hpp"
#include "support/text_file.hpp"

namespace meridian::inspect {
namespace {

/// A shipped machine file with `from` replaced.
MachineModel machine_with(const std::string& name, const std::string& from, const std::string& to) {
  std::string text = test::read_text(test::shipped_file(name));
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return config::parse_machine(text.replace(at, from.size(), to), name);
}

class EveryShipped : public testing::TestWithParam<std::string> {
 protected:
  const MachineModel model_ = config::load_machine(test::shipped_file(GetParam()));
};

/// The tool where the joints are `q`, from the skeleton alone: screws one after the other.
ToolPose moved_by_screws(const Skeleton& s, const JointVector& q) {
  ToolPose pose{s.tip, s.axis};
  for (auto joint = s.joints.rbegin(); joint != s.joints.rend(); ++joint) {
    const auto i = static_cast<std::size_t>(joint->joint);
    // Moving the workpiece is moving the tool the other way, as the workpiece sees it.
    const double distance = (joint->side == Side::kTable ? -1 : 1) * (q[i] - s.joints_there[i]);
    if (joint->is_rotary) {
      const Eigen::AngleAxisd turn(distance, joint->direction);
      pose = {joint->point + turn * (pose.tip - joint->point), turn * pose.axis};
    } else {
      pose.tip += distance * joint->direction;
    }
  }
  return pose;
}

TEST_P(EveryShipped, HasASkeletonWhoseAxesGiveItsForwardKinematics) {
  const Skeleton s = skeleton_of(model_);
  ASSERT_EQ(s.joints.size(), static_cast<std::size_t>(model_.joint_count));
  EXPECT_LT((s.gauge - model_.tool_length_mm * s.axis - s.tip).norm(), 1e-12);
  std::mt19937_64 draw(7);
  for (int n = 0; n < 50; ++n) {
    JointVector q{};
    for (std::size_t i = 0; i < s.joints.size(); ++i) {
      const double max = model_.joints[i].is_rotary ? 3 : 500;
      q[i] = std::uniform_real_distribution<double>(-max, max)(draw);
    }
    const ToolPose want = pose_in_machine(model_, forward(model_, model_.tool_length_mm, q));
    const ToolPose is = moved_by_screws(s, q);
    EXPECT_LT((is.tip - want.tip).norm(), 1e-9);
    EXPECT_LT((is.axis - want.axis).norm(), 1e-12);
  }
}

TEST_P(EveryShipped, HasNothingToWarnOfAndComesHome) {
  const Inspection in = inspect(model_);
  EXPECT_TRUE(in.warnings.empty()) << in.warnings.front();
  EXPECT_TRUE(in.is_origin_in_reach);
  EXPECT_LT(in.round_trip_mm, 1e-9);
  // A machine whose C is limited reaches some azimuths alone.
  EXPECT_GT(in.some_tilt, 0.99);  // rad; what a machine must tilt to be called five-axis here
  EXPECT_GE(in.some_tilt, in.all_tilt);
  EXPECT_NE(to_text(in, model_).find("no warnings"), std::string::npos);
}

TEST_P(EveryShipped, HasAPatternThatMovesEveryJointAlone) {
  const std::vector<ClBlock> blocks = joint_pattern(model_);
  const JointVector begin = trial_joints(model_);
  JointVector q = begin;
  std::array<double, kMaxJoints> reached{};
  for (const ClBlock& block : blocks) {
    if (!is_motion(block.kind)) continue;
    const ToolPose pose{to_vector(block.tip_mm), to_vector(block.axis)};
    double nearest = 1e9;
    JointVector best{};
    for (int branch = 0; branch < branch_count(model_); ++branch) {
      const auto solution = solve(model_, model_.tool_length_mm, pose, branch, q);
      if (solution.status == SolveStatus::kUnreachable) continue;
      double distance = 0;
      for (std::size_t i = 0; i < q.size(); ++i) distance += std::abs(solution.q[i] - q[i]);
      if (distance < nearest) best = solution.q;
      nearest = std::min(nearest, distance);
    }
    q = best;
    EXPECT_LT(first_joint_outside_travel(model_, q, 1e-6), 0);
    int moving = 0;
    for (std::size_t i = 0; i < q.size(); ++i) {
      reached[i] = std::max(reached[i], std::abs(q[i] - begin[i]));
      if (std::abs(q[i] - begin[i]) > 1e-6) ++moving;
    }
    EXPECT_LE(moving, 1);
  }
  for (int i = 0; i < model_.joint_count; ++i) {
    const JointSpec& joint = model_.joints[static_cast<std::size_t>(i)];
    if (joint.name == "spin") continue;  // the pose does not show it
    EXPECT_NEAR(reached[static_cast<std::size_t>(i)],
                joint.is_rotary ? 5 * std::acos(-1.0) / 180 : 10, 1e-6)
        << joint.name;
  }
}

TEST_P(EveryShipped, HasAPatternThatReadsBack) {
  std::ostringstream out;
  write_joint_pattern(model_, out);
  const std::string text = out.str();
  cl::ClReader reader(std::string_view(text), "pattern");
  std::size_t count = 0;
  for (auto block = reader.next();; block = reader.next(), ++count) {
    ASSERT_TRUE(block) << block.error().text();
    if (!*block) break;
  }
  EXPECT_EQ(count, joint_pattern(model_).size());
  EXPECT_TRUE(reader.warnings().empty());
}

INSTANTIATE_TEST_SUITE_P(Machine, EveryShipped, testing::ValuesIn(test::shipped_machines()),
                         test::test_name);

TEST(Inspection, NamesTheKeepOutBoxes) {
  const MachineModel model = machine_with(
      "trunnion-ac", "[tolerances]",
      "[[keep_out]]\nname = \"vice\"\nX_mm = [100, 250]\nA_deg = [-90, -10]\n[tolerances]");
  EXPECT_NE(to_text(inspect(model), model)
                .find("keep out   vice       X 100 .. 250 mm A -90 .. -10 deg\n"),
            std::string::npos)
      << to_text(inspect(model), model);
}

TEST(Inspection, NamesTheTipBox) {
  const MachineModel model = machine_with(
      "trunnion-ac", "[tolerances]",
      "[tip_box]\nmin_mm = [-900, -900, -900]\nmax_mm = [900, 800.5, 900]\n[tolerances]");
  EXPECT_NE(to_text(inspect(model), model)
                .find("tip box    X -900 .. 900 Y -900 .. 800.5 Z -900 .. 900 mm over the base\n"),
            std::string::npos)
      << to_text(inspect(model), model);
}

TEST(Inspection, ReportsWhatAJointDoesAsTheWorkpieceSeesIt) {
  const MachineModel model = config::load_machine(test::shipped_file("head-table-bc"));
  const std::string text = to_text(inspect(model), model);
  EXPECT_NE(text.find("workpiece - C - X - Y - Z - B - tool"), std::string::npos) << text;
  EXPECT_NE(text.find("+ moves the table towards +x"), std::string::npos) << text;
  EXPECT_NE(text.find("tip by (-10.0000, 0.0000, 0.0000) mm; axis stays"), std::string::npos)
      << text;
  EXPECT_NE(text.find("C is free there"), std::string::npos) << text;
  EXPECT_NE(text.find("every tool axis to 110 deg"), std::string::npos) << text;
}

TEST(Inspection, StepsBackwardsWhereTravelEndsAtHome) {
  const MachineModel model =
      machine_with("trunnion-ac", "travel_mm = [-700, 700]", "travel_mm = [-700, 0]");
  EXPECT_EQ(inspect(model).trials[0].step, -10);
}

bool is_warned(const MachineModel& model, const std::string& word) {
  const Inspection in = inspect(model);
  return std::any_of(in.warnings.begin(), in.warnings.end(),
                     [&](const std::string& w) { return w.find(word) != std::string::npos; });
}

TEST(Slips, AreFoundInDirectionsPivotsTravelLimitsAndFrame) {
  const char* machine = "trunnion-ac";
  EXPECT_TRUE(is_warned(machine_with(machine, "direction = [1, 0, 0]", "direction = [1, 0.01, 0]"),
                        "X runs 0.5729 deg beside"));
  EXPECT_TRUE(is_warned(machine_with(machine, "direction = [0, 1, 0]", "direction = [1, 0.3, 0]"),
                        "nearly in one plane"));
  EXPECT_TRUE(is_warned(machine_with(machine, "point_mm = [0, 0, -40]", "point_mm = [0, 0.1, -40]"),
                        "miss each other by 0.1 mm"));
  EXPECT_TRUE(is_warned(machine_with(machine, "jerk_mm_per_s3 = 60000", "jerk_mm_per_s3 = 6"),
                        "to its full acceleration"));
  EXPECT_TRUE(is_warned(
      machine_with(machine, "acceleration_mm_per_s2 = 3000", "acceleration_mm_per_s2 = 3"),
      "to its full velocity"));
  EXPECT_TRUE(is_warned(machine_with(machine, "origin_mm = [0, 0, 0]", "origin_mm = [0, 5000, 0]"),
                        "out of reach"));
  MachineModel far = config::load_machine(test::shipped_file("trunnion-ac"));
  far.joints[0].limits.travel_min = 5;
  far.joints[0].home = 10;
  EXPECT_TRUE(is_warned(far, "cannot stand at zero"));
}

/// A machine whose joint `at` is changed.
MachineModel changed(std::size_t at, const std::function<void(JointSpec&)>& change) {
  MachineModel model = config::load_machine(test::shipped_file("trunnion-ac"));
  change(model.joints[at]);
  return model;
}

TEST(Slips, AreFoundInNumbersOfAnotherUnit) {
  const auto scaled = [](std::size_t at, double JointLimits::*number, double by) {
    return changed(at, [&](JointSpec& joint) { joint.limits.*number *= by; });
  };
  const auto with_travel = [](std::size_t at, double min, double max) {
    return changed(at, [&](JointSpec& joint) {
      joint.is_endless = false;
      joint.limits.travel_min = min;
      joint.limits.travel_max = max;
    });
  };
  constexpr std::size_t kX = 0, kTilt = 4;
  EXPECT_TRUE(is_warned(scaled(kX, &JointLimits::velocity, 60), "to its full velocity and back"));
  EXPECT_TRUE(is_warned(scaled(kX, &JointLimits::velocity, 0.06), "times as fast as X"));
  EXPECT_TRUE(is_warned(scaled(kX, &JointLimits::following_error, 1000), "error of X, "));
  EXPECT_TRUE(is_warned(scaled(kTilt, &JointLimits::velocity, units::rad_from_deg(1)), "deg/s at"));
  EXPECT_TRUE(is_warned(with_travel(kX, -10.8, 10.8), "X has a travel of 21.6 mm"));
  const double rad_as_deg = units::rad_from_deg(2.0944);
  EXPECT_TRUE(is_warned(with_travel(kTilt, -0.01, rad_as_deg), "deg: is the unit right"));
  EXPECT_TRUE(is_warned(changed(kX, [](JointSpec& joint) { joint.nc_word = "-Y"; }),
                        "X and Y have one word in NC programs, Y"));
}

TEST(Pole, ThatIsPrintedIsTheOneNearHome) {
  for (const char* turned : {"[0, 0, 1]", "[0, 0, -1]"}) {
    const MachineModel model =
        machine_with("trunnion-ac", "side = \"table\"\ndirection = [0, 0, 1]",
                     std::string("side = \"table\"\ndirection = ") + turned);
    EXPECT_NE(to_text(inspect(model), model).find("pole       tool axis along +z"),
              std::string::npos)
        << turned;
  }
}

TEST(Slips, AreFactsWhereTheFileSaysThatItsNumbersAreMeasured) {
  const char* machine = "trunnion-ac";
  const std::string off = "point_mm = [0, 0.1, -40]";
  EXPECT_FALSE(inspect(machine_with(machine, "point_mm = [0, 0, -40]", off)).warnings.empty());
  MachineModel model = machine_with(machine, "point_mm = [0, 0, -40]", off);
  model.is_measured = true;
  EXPECT_TRUE(inspect(model).warnings.empty());
  const std::string text = to_text(inspect(model), model);
  EXPECT_NE(text.find("measured   the rotary axes miss each other by 0.1 mm\n"), std::string::npos)
      << text;
  EXPECT_TRUE(machine_with(machine, "tool_axis =", "measured = true\ntool_axis =").is_measured);
}

TEST(Pole, ThatTheToolAxisMissesIsReportedAndOneThatItMissesByMoreIsWarnedOf) {
  const std::string c = "kind = \"rotary\"\nside = \"table\"\ndirection = [0, 0, 1]";
  const auto leaning = [&](const char* x) {
    std::string to = c;
    return machine_with("trunnion-ac", c,
                        to.replace(to.find("[0, 0, 1]"), 2, std::string("[") + x));
  };
  const MachineModel missed = leaning("1e-4");
  EXPECT_NE(to_text(inspect(missed), missed).find("the tool axis misses it by 0.00573 deg; "),
            std::string::npos);
  const std::string hole = "no tool axis comes within 0.286 deg of that of C";
  EXPECT_FALSE(is_warned(missed, "no tool axis comes within"));
  EXPECT_TRUE(is_warned(leaning("5e-3"), hole));
  EXPECT_TRUE(is_warned(leaning("1.9e-3"), "on the pole the tool axis is off by 0.109 deg"));
  const MachineModel usual = config::load_machine(test::shipped_file("trunnion-ac"));
  EXPECT_EQ(to_text(inspect(usual), usual).find("misses"), std::string::npos);
}

TEST(Slips, AreNotDirectionsThatSomebodyBuilds) {
  EXPECT_TRUE(
      inspect(machine_with("trunnion-ac", "point_mm = [0, 0, -40]", "point_mm = [0, 25, -40]"))
          .warnings.empty());
  EXPECT_TRUE(
      inspect(machine_with("nutating-head", "direction = [0, 1, 1]", "direction = [0, 1, 2]"))
          .warnings.empty());
}

}  // namespace
}  // namespace meridian::inspect
