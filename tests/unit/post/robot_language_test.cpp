// SPDX-License-Identifier: Apache-2.0
// Programs in robots' own languages: read back by strict readers, the joints are those of the plain
// joint program of the same file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "support/nc_program.hpp"
#include "support/robot_reader.hpp"
#include "unit/post/written.hpp"

namespace meridian {
namespace {

using post::Dialect;

constexpr Dialect kLanguages[] = {Dialect::kKrl, Dialect::kRapid, Dialect::kLs, Dialect::kUrScript};
constexpr double kRadianDigit_deg = 0.5e-7 * 57.3 + 1e-9;

MachineModel robot(const std::string& name = "robot-6r") {
  MachineModel model = test::shipped(name);
  config::place_workpiece(model, config::parse_frame("850,0,250"));
  return model;
}

test::RobotRead read(Dialect dialect, const std::string& text) {
  switch (dialect) {
    case Dialect::kKrl:
      return test::read_krl(text);
    case Dialect::kRapid:
      return test::read_rapid(text);
    case Dialect::kLs:
      return test::read_ls(text);
    default:
      return test::read_urscript(text);
  }
}

/// Fast enough for KRL: above 1 percent of the axes' speed.
std::string fast(const std::string& middle) {
  return "UNITS/MM\nMULTAX/ON\nFEDRAT/12000,MMPM\nGOTO/100,0,0,0,0,1\n" + middle + "FINI\n";
}

const char* const kPart =
    "GOTO/60,20,0,0.1,0,0.99498743710662\nDELAY/0.5\nGOTO/20,60,5,0.1,0,0.99498743710662\nRAPID\n"
    "GOTO/20,60,40,0.1,0,0.99498743710662\n";

post::PostOptions in(Dialect dialect) {
  post::PostOptions options;
  options.dialect = dialect;
  return options;
}

TEST(RobotLanguage, EveryLanguageHasTheJointsAndTheTimesOfTheJointProgram) {
  const auto plain = test::written(fast(kPart), robot());
  ASSERT_TRUE(plain) << plain.error().message;
  const auto moves = test::read_nc(plain->text).moves;
  for (const Dialect dialect : kLanguages) {
    SCOPED_TRACE(static_cast<int>(dialect));
    const auto program = test::written(fast(kPart), robot(), in(dialect));
    ASSERT_TRUE(program) << program.error().message;
    const test::RobotRead got = read(dialect, program->text);
    ASSERT_EQ(got.error, "");
    EXPECT_EQ(got.name, dialect == Dialect::kLs ? "PART" : "part");
    EXPECT_EQ(got.halts, 1);
    ASSERT_EQ(got.points.size(), moves.size());
    for (std::size_t n = 0; n < moves.size(); ++n) {
      for (std::size_t k = 0; k < 6; ++k) {
        const double scale = dialect == Dialect::kUrScript ? 180 / M_PI : 1;
        EXPECT_NEAR(got.points[n].joints[k] * scale, moves[n].at.at("J" + std::to_string(k + 1)),
                    dialect == Dialect::kUrScript ? kRadianDigit_deg : 1e-9);
      }
      if (n == 0 || moves[n].is_rapid || dialect == Dialect::kKrl) continue;
      // F in inverse time has three decimals and is rounded down: times up by 0.05 % of 60/F.
      const double seconds = 60 / moves[n].feed;
      EXPECT_NEAR(got.points[n].seconds, seconds, 1.1e-3 + 6e-4 * seconds);
    }
  }
}

TEST(RobotLanguage, AJointsSignAndZeroAreTheControllers) {
  MachineModel model = robot();
  model.joints[1].nc_word = "-J2";
  post::PostOptions options = in(Dialect::kKrl);
  options.zero_deg = {0, 90, -12.5, 0, 0, 0};
  const auto program = test::written(fast(kPart), model, options);
  ASSERT_TRUE(program) << program.error().message;
  const test::RobotRead got = test::read_krl(program->text);
  ASSERT_EQ(got.error, "");
  // Home is 0, 60, -90, 0, -60, 0 in the machine file.
  const std::vector<double> home = {0, 90 - 60, -90 - 12.5, 0, -60, 0};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(got.points[0].joints[k], home[k], 1e-9) << k;
}

TEST(RobotLanguage, ACoupledForearmCountsFromTheHorizontal) {
  post::PostOptions options = in(Dialect::kLs);
  options.is_forearm_coupled = true;
  const auto program = test::written(fast(kPart), robot(), options);
  ASSERT_TRUE(program);
  const test::RobotRead got = test::read_ls(program->text);
  ASSERT_EQ(got.error, "");
  EXPECT_NEAR(got.points[0].joints[2], 60 - 90, 1e-9);
}

TEST(RobotLanguage, TheFirstMoveIsSlowAndTheOperatorIsAskedBeforeIt) {
  for (const Dialect dialect : kLanguages) {
    const auto program = test::written(fast(""), robot(), in(dialect));
    ASSERT_TRUE(program) << program.error().message;
    const test::RobotRead got = read(dialect, program->text);
    ASSERT_EQ(got.error, "");
    EXPECT_EQ(got.halts, 1);
    EXPECT_EQ(got.points[0].seconds, 0);
    EXPECT_LE(got.points[0].percent, 10);
  }
}

TEST(RobotLanguage, SpindleCoolantAndToolAreTheOperators) {
  const std::string text =
      "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/6000,RPM,CLW\nCOOLNT/FLOOD\nFEDRAT/12000,MMPM\n"
      "GOTO/100,0,0,0,0,1\nCOOLNT/OFF\nSPINDL/OFF\nSTOP\nFINI\n";
  for (const Dialect dialect : kLanguages) {
    const auto program = test::written(text, robot(), in(dialect));
    ASSERT_TRUE(program) << program.error().message;
    EXPECT_EQ(read(dialect, program->text).halts, 7) << program->text;
    if (dialect == Dialect::kLs) continue;  // remarks of 32 characters
    EXPECT_NE(program->text.find("SPINDLE ON, 6000 RPM CLOCKWISE"), std::string::npos);
  }
}

TEST(RobotLanguage, KrlIsNeverFasterThanItsFeedAndSaysSoWhereItWouldBe) {
  const std::string slow =
      "UNITS/MM\nMULTAX/ON\nFEDRAT/60,MMPM\nGOTO/100,0,0,0,0,1\nGOTO/60,0,0\nFINI\n";
  const auto refused = test::written(slow, robot(), in(Dialect::kKrl));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().line, 5U);
  EXPECT_NE(refused.error().message.find("below 1 percent"), std::string::npos);

  const auto plain = test::written(fast(kPart), robot());
  const auto krl = test::written(fast(kPart), robot(), in(Dialect::kKrl));
  ASSERT_TRUE(plain && krl);
  const auto moves = test::read_nc(plain->text).moves;
  const test::RobotRead got = test::read_krl(krl->text);
  ASSERT_EQ(got.points.size(), moves.size());
  for (std::size_t n = 1; n < moves.size(); ++n) {
    if (moves[n].is_rapid) continue;
    double turn_deg = 0;
    for (std::size_t k = 0; k < 6; ++k) {
      turn_deg =
          std::max(turn_deg, std::abs(got.points[n].joints[k] - got.points[n - 1].joints[k]));
    }
    const double seconds = turn_deg / (90 * got.points[n].percent / 100);  // 90 deg/s each
    EXPECT_GE(seconds, 60 / moves[n].feed * (1 - 1e-3));
  }
}

TEST(RobotLanguage, NamesKeepTheRulesOfTheLanguage) {
  const auto name = [](Dialect dialect, const std::string& file, const std::string& given = "") {
    post::PostOptions options = in(dialect);
    options.program_name = given;
    const auto program = test::written(fast(""), robot(), options, file);
    return program ? read(dialect, program->text).name : "refused: " + program.error().message;
  };
  EXPECT_EQ(name(Dialect::kLs, "a long part-name.apt"), "A_LONG_P");
  EXPECT_EQ(name(Dialect::kRapid, "7 up.apt"), "P_7_up");
  EXPECT_EQ(name(Dialect::kKrl, "module.apt"), "P_module");
  EXPECT_EQ(name(Dialect::kUrScript, "x.apt", "blade_2"), "blade_2");
  EXPECT_EQ(name(Dialect::kLs, "x.apt", "BLADE_WITH_A_LONG_NAME"), "BLADE_WITH_A_LONG_NAME");
  EXPECT_EQ(name(Dialect::kLs, "x.apt", "blade").substr(0, 7), "refused");
  EXPECT_EQ(name(Dialect::kKrl, "x.apt", std::string(25, 'a')).substr(0, 7), "refused");
  EXPECT_EQ(name(Dialect::kRapid, "x.apt", "endproc").substr(0, 7), "refused");
}

TEST(RobotLanguage, OtherMachinesAreRefused) {
  for (const Dialect dialect : kLanguages) {
    const auto program =
        test::written(test::program_with(""), test::shipped("trunnion-ac"), in(dialect));
    ASSERT_FALSE(program);
    const char* const why = dialect == Dialect::kUrScript ? "six joints" : "nc_word = \"J1\"";
    EXPECT_NE(program.error().message.find(why), std::string::npos);
  }
  const auto five = test::written(fast(""), robot("robot-5r"), in(Dialect::kUrScript));
  ASSERT_FALSE(five);
  EXPECT_NE(five.error().message.find("six joints"), std::string::npos);
  EXPECT_TRUE(test::written(fast(""), robot("robot-5r"), in(Dialect::kLs)));
}

TEST(RobotLanguage, ASmallProgramIsTheOneThatWasWrittenByHand) {
  // The spin of the wrist rests at 0; the arm stands at home before the approach.
  const auto program = test::written(fast(""), robot(), in(Dialect::kUrScript));
  ASSERT_TRUE(program);
  EXPECT_NE(program->text.find("  movej([0.0000000, 1.0471976, -1.5707963, 0.0000000, -1.0471976, "
                               "0.0000000], a=0.2, v=0.1)\n"),
            std::string::npos)
      << program->text;
  const auto rapid = test::written(fast(""), robot(), in(Dialect::kRapid));
  ASSERT_TRUE(rapid);
  EXPECT_NE(rapid->text.find("MoveAbsJ [[0.00000,60.00000,-90.00000,0.00000,-60.00000,0.00000],"
                             "[9E9,9E9,9E9,9E9,9E9,9E9]]\\NoEOffs,v50,fine,tool0;\n"),
            std::string::npos);
}

}  // namespace
}  // namespace meridian
