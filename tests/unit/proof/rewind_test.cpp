// SPDX-License-Identifier: Apache-2.0
// Where C runs out of its travel a posted program turns it back off the part, and cuts the part.
#include "service/programs/proof/rewind.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <sstream>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "service/programs/proof/program_check.hpp"
#include "support/nc_program.hpp"
#include "unit/post/written.hpp"

namespace meridian {
namespace {

constexpr double kRetract_mm = 15;
constexpr double kTravel_deg = 200;

/// A trunnion whose table turns little farther than once; `is_tilted_both`: its tilt has travel for
/// either branch.
MachineModel narrow_machine(RewindPolicy policy, bool is_tilted_both = false) {
  MachineModel model = test::shipped("trunnion-ac");
  model.joints[redundant_joint(model)].is_endless = false;
  JointLimits& limits = model.joints[redundant_joint(model)].limits;
  limits.travel_min = -units::rad_from_deg(kTravel_deg);
  limits.travel_max = units::rad_from_deg(kTravel_deg);
  JointLimits& tilt = model.joints[redundant_joint(model) == 3 ? 4 : 3].limits;
  tilt.travel_min = is_tilted_both ? -tilt.travel_max : 0;
  model.rewind_policy = policy;
  model.rewind_retract_mm = kRetract_mm;
  return model;
}

/// Round a cone by 460 degrees, the tool leaning outwards.
std::string round_a_cone() {
  std::string text = "UNITS/MM\nMULTAX/ON\nFEDRAT/1200,MMPM\n";
  for (int deg = 0; deg <= 460; deg += 4) {
    const double at = units::rad_from_deg(deg);
    char line[160];
    std::snprintf(line, sizeof line, "GOTO/%.6f,%.6f,0,%.9f,%.9f,%.9f\n", 30 * std::cos(at),
                  30 * std::sin(at), std::sin(0.2) * std::cos(at), std::sin(0.2) * std::sin(at),
                  std::cos(0.2));
    text += line;
  }
  return text + "FINI\n";
}

proof::ProgramReport checked(const std::string& program, const MachineModel& model) {
  std::istringstream in(program);
  const auto steps = proof::read_joint_program(in, model);
  EXPECT_TRUE(steps) << steps.error().message;
  std::vector<ClBlock> blocks;
  const std::string part = round_a_cone();
  cl::ClReader reader(part, "part.apt");
  for (auto block = reader.next(); block && *block; block = reader.next()) {
    blocks.push_back(**block);
  }
  return proof::check_program(*steps, blocks, model, {}, {});
}

TEST(Rewind, LeavesThePartTurnsCAloneAndComesBackAtTheApproachFeed) {
  const MachineModel model = narrow_machine(RewindPolicy::kRetract);
  const auto program = test::written(round_a_cone(), model);
  ASSERT_TRUE(program) << program.error().message;
  const auto moves = test::read_nc(program->text).moves;
  int rewinds = 0;
  for (std::size_t n = 2; n + 1 < moves.size(); ++n) {
    ASSERT_LE(std::abs(moves[n].at.at("C")), kTravel_deg + 1e-4);
    const double turn = moves[n].at.at("C") - moves[n - 1].at.at("C");
    if (std::abs(turn) < 300) continue;
    ++rewinds;
    EXPECT_NEAR(std::abs(turn), 360, 1e-4);
    EXPECT_TRUE(moves[n - 1].is_rapid && moves[n].is_rapid);
    auto without_turn = moves[n].at;
    without_turn["C"] = moves[n - 1].at.at("C");
    EXPECT_EQ(without_turn, moves[n - 1].at);
    EXPECT_NEAR(moves[n].at.at("Z") - moves[n - 2].at.at("Z"), kRetract_mm, 2e-4);
    EXPECT_FALSE(moves[n + 1].is_rapid);
    EXPECT_NEAR(moves[n + 1].at.at("Z"), moves[n - 2].at.at("Z"), 1e-9);
    const double down_s = units::kMinute_s / moves[n + 1].feed;
    EXPECT_NEAR(down_s, kRetract_mm / model.approach_feed_mm_per_s, 0.01 * down_s);
  }
  EXPECT_EQ(rewinds, 1);
}

TEST(Rewind, IsNoPartOfThePathThatTheProgramIsHeldAgainst) {
  for (const bool is_tilted_both : {false, true}) {
    const MachineModel model = narrow_machine(RewindPolicy::kRetract, is_tilted_both);
    const auto program = test::written(round_a_cone(), model);
    ASSERT_TRUE(program) << program.error().message;
    const proof::ProgramReport report = checked(program->text, model);
    EXPECT_TRUE(report.passed()) << proof::to_text(report);
    EXPECT_EQ(report.rewinds, 1U);
  }
}

TEST(Rewind, ToTheOtherBranchTurnsThroughThePoleWithTheTipAtRest) {
  const MachineModel model = narrow_machine(RewindPolicy::kRetract, true);
  const auto program = test::written(round_a_cone(), model);
  ASSERT_TRUE(program) << program.error().message;
  const auto moves = test::read_nc(program->text).moves;
  double first = 0, last = 0;
  int at_pole = 0;
  for (const auto& move : moves) {
    const auto tilt = move.at.find("A");
    if (tilt == move.at.end()) continue;
    if (first == 0) first = tilt->second;
    last = tilt->second;
    if (first != 0 && move.is_rapid && std::abs(last) < 1e-4) ++at_pole;
  }
  EXPECT_GT(at_pole, 0) << "no rewind through the pole";
  EXPECT_LT(first * last, 0) << "the same branch";
}

TEST(Rewind, InThePartIsFound) {
  const MachineModel model = narrow_machine(RewindPolicy::kRetract);
  const auto program = test::written(round_a_cone(), model);
  ASSERT_TRUE(program) << program.error().message;
  // Without the line that leaves the part, C turns in it.
  std::istringstream in(program->text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  std::size_t turn = 0;
  for (std::size_t n = lines.size(); n-- > 0 && turn == 0;) {
    if (lines[n].starts_with("G0 C")) turn = n;
  }
  ASSERT_GT(turn, 10U);
  lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(turn) - 1);
  std::string spoilt;
  for (const std::string& line : lines) spoilt += line + "\n";
  const proof::ProgramReport report = checked(spoilt, model);
  EXPECT_FALSE(report.passed());
  EXPECT_EQ(report.rewinds, 0U);
}

TEST(Rewind, ThatCannotBeWrittenIsRefusedWithTheWayOut) {
  const auto refused = test::written(round_a_cone(), narrow_machine(RewindPolicy::kRefuse));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("[rewind] policy = \"retract\""), std::string::npos)
      << refused.error().message;
  post::PostOptions options;
  options.dialect = post::Dialect::kFanuc;
  options.offset_number = 1;
  const auto tip = test::written(round_a_cone(), narrow_machine(RewindPolicy::kRetract), options);
  ASSERT_FALSE(tip);
  EXPECT_NE(tip.error().message.find("--dialect joints writes the rewind"), std::string::npos)
      << tip.error().message;
}

}  // namespace
}  // namespace meridian
