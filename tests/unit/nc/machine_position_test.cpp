// SPDX-License-Identifier: Apache-2.0
// G28 and G53: moves to positions of the machine.
#include <gtest/gtest.h>

#include "meridian/kinematics/kinematics.hpp"
#include "service/programs/post/axis_words.hpp"
#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

constexpr double kNear_mm = 1e-6;

/// Rotary axes that are sent to zero of the machine before the first motion, and a cut behind it.
TEST(NcMachinePosition, OfRotaryAxesIsKnownWhereTheMachineIs) {
  const auto options = on(shipped("trunnion-bc"));
  const std::string cut = "G90 G0 X0. Y0. Z5.\nG1 Z0.\n";
  for (const char* sent : {"G91 G28 B0. C0.\n", "G53 G0 B0. C0.\n"}) {
    const ReadText read = read_nc(sent + cut, options);
    ASSERT_EQ(read.error, "") << sent;
    EXPECT_EQ(to_vector(read.motion().back().tip_mm), Vector3(0, 0, 0)) << sent;
  }
  EXPECT_EQ(read_siemens("SUPA G0 B0 C0\nG0 X0 Y0 Z5\nG1 Z0\n", siemens(options)).error, "");
  EXPECT_EQ(read_klartext("1 L B+0 C+0 R0 FMAX M91\n2 L X+0 Y+0 Z+5 FMAX\n3 L Z+0 F9\n",
                          klartext(options))
                .error,
            "");
  EXPECT_NE(read_nc("G53 G0 B30. C0.\n" + cut, options).error.find("is not at zero"),
            std::string::npos);
  EXPECT_NE(read_nc("G91 G28 B0.\n" + cut).error.find("where rotary axis B stands is not known"),
            std::string::npos);
  EXPECT_NE(read_nc("G91 G30 B0.\n" + cut, options).error.find("axis B stands is not known"),
            std::string::npos)
      << "the file has no such position";
}

TEST(SiemensMachinePosition, IsFlaggedWhereTheControlMayAddTheToolsLength) {
  const auto options = siemens(on(shipped("trunnion-bc")));
  const std::string supa = "G0 X0 Y0 Z50\nSUPA G0 Z0\n";
  EXPECT_TRUE(read_siemens("T1 D1 M6\n" + supa, options).warned_of("$MN_G53_TOOLCORR"));
  EXPECT_FALSE(read_siemens("T1 D1 M6\nG0 X0 Y0 Z50\nSUPA D0 G0 Z0\n", options)
                   .warned_of("$MN_G53_TOOLCORR"));
}

TEST(NcMachinePositions, MeanNothingBeforeTheFirstMotion) {
  const ReadText read = read_nc("G91 G28 Z0.\nG90\nG0 X0. Y0. Z5.\n");
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.motion().size(), 1U);
}

TEST(NcMachinePositions, NeedTheMachineBehindIt) {
  const ReadText read = read_nc("G0 X0. Y0. Z5.\nG91 G28 Z0.\n");
  EXPECT_NE(read.error.find("G28 moves to a place of the machine, which is not known here; "
                            "--machine FILE"),
            std::string::npos)
      << read.error;
}

TEST(NcMachinePositions, LiftTheToolToTheHomeOfItsAxis) {
  MachineModel model = shipped("trunnion-ac");
  const ReadText read = read_nc("G0 X1. Y2. Z5.\nG91 G28 Z0.\nG90 X3.\n", on(model));
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 3U);
  EXPECT_EQ(motion[1].kind, BlockKind::kRapid);
  EXPECT_NEAR(motion[1].tip_mm[0], 1, kNear_mm);
  EXPECT_NEAR(motion[1].tip_mm[1], 2, kNear_mm);
  JointVector home{};
  for (int i = 0; i < model.joint_count; ++i) home[i] = model.joints[i].home;
  const double height = forward(model, model.tool_length_mm, home).tip[2];
  EXPECT_NEAR(motion[1].tip_mm[2], height, kNear_mm);
  EXPECT_NEAR(motion[2].tip_mm[0], 3, kNear_mm);
  EXPECT_NEAR(motion[2].tip_mm[2], height, kNear_mm);
}

TEST(NcMachinePositions, OfG30AreTheMachineFilesPositions) {
  const MachineModel model = shipped("trunnion-ac");
  const auto words = post::AxisWords::of(model);
  ASSERT_TRUE(words);
  ClReaderOptions options = on(model);
  std::vector<double> change(static_cast<std::size_t>(model.joint_count));
  change[static_cast<std::size_t>(words->find("Z"))] = words->axis(words->find("Z"), -25);
  options.positions = {{"G30", change}};
  const ReadText named = read_nc("G0 X1. Y2. Z5.\nG91 G30 Z0.\nG91 G30 P2 Z0.\n", options);
  const ReadText by_value = read_nc("G0 X1. Y2. Z5.\nG53 G0 Z-25.\nG53 Z-25.\n", on(model));
  ASSERT_EQ(named.error, "");
  ASSERT_EQ(named.motion().size(), by_value.motion().size());
  EXPECT_LT((tip(named.motion()[1]) - tip(by_value.motion()[1])).norm(), kTiny);
  EXPECT_EQ(read_nc("G91 G30 Z0.\nG90 G0 X1. Y2. Z5.\n", on(model)).error, "")
      << "nothing moved yet";
  for (const auto& [body, says] : std::vector<std::pair<const char*, const char*>>{
           {"G0 X1. Y2. Z5.\nG91 G30 P3 Z0.\n", "[[position]] with name = \"G30 P3\""},
           {"G0 X1. Y2. Z5.\nG30 Z0.\n", "write G91 G30 with zeros"}}) {
    const std::string error = read_nc(body, options).error;
    EXPECT_NE(error.find(says), std::string::npos) << error;
  }
}

TEST(NcMachinePositions, OfG53AreJointPositions) {
  const MachineModel model = shipped("trunnion-ac");
  const auto words = post::AxisWords::of(model);
  ASSERT_TRUE(words);
  const int z = words->find("Z");
  const ReadText read = read_nc("G0 X1. Y2. Z5.\nG53 G0 Z-10.\n", on(model));
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 2U);
  const ToolPose pose{tip(motion[1]), axis(motion[1])};
  const auto solved = solve(model, model.tool_length_mm,
                            Pose<double>{{pose.tip[0], pose.tip[1], pose.tip[2]},
                                         {pose.axis[0], pose.axis[1], pose.axis[2]}},
                            0, JointVector{});
  EXPECT_NEAR(words->value(z, solved.q[z]), -10, 1e-3);
}

TEST(NcMachinePositions, AreNotReachedByWayOfAPoint) {
  const ReadText read = read_nc("G0 X1. Y2. Z5.\nG28 Z0.\n", on(shipped("trunnion-ac")));
  EXPECT_NE(read.error.find("by way of a point between; write G91 G28"), std::string::npos);
}

TEST(NcMachinePositions, RapidsThatTurnWithoutToolCentreControlAreSaid) {
  const ReadText read =
      read_nc("G0 A0. C0.\nG43.4 H1\nG0 X1. Y2. Z5.\nG49\nG0 A30.\nG43.4 H1\nG0 X1. Y2. Z9.\n",
              on(shipped("trunnion-ac")));
  ASSERT_EQ(read.error, "");
  EXPECT_TRUE(read.warned_of("rapids after which the tip is not known"));
  EXPECT_EQ(read.motion().size(), 2U);
}

}  // namespace
}  // namespace meridian::nc
