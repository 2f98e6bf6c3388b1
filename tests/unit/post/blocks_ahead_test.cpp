// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/blocks_ahead.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "meridian/units.hpp"
#include "unit/post/written.hpp"

namespace meridian {
namespace {

std::string points(int count) {
  std::string out;
  for (int n = 1; n <= count; ++n) out += "GOTO/" + std::to_string(n) + ",0,0\n";
  return out;
}

TEST(BlocksAhead, GiveEveryBlockInItsTurnWithThoseThatFollow) {
  constexpr int kCount = 5000;
  const std::string text = "UNITS/MM\nFEDRAT/100,MMPM\n" + points(kCount) + "FINI\n";
  cl::ClReader reader(text, "part.apt");
  post::BlocksAhead blocks(reader);
  EXPECT_TRUE(blocks.ahead().empty());
  std::uint64_t count = 0;
  for (auto block = blocks.next(); block && *block; block = blocks.next()) {
    ASSERT_EQ((*block)->sequence, count);
    ++count;
    ASSERT_EQ(blocks.ahead().front().sequence, (*block)->sequence);
    ASSERT_EQ(blocks.ahead().size(),
              std::min<std::uint64_t>(post::BlocksAhead::kAhead, kCount + 2 - count));
  }
  EXPECT_EQ(count, kCount + 1U);
}

TEST(BlocksAhead, EndAtAToolChangeAndReportAnErrorBehindTheBlocksBeforeIt) {
  const std::string text = "UNITS/MM\nFEDRAT/100,MMPM\n" + points(2) + "LOADTL/2\n" + points(1) +
                           "GOTO/nowhere\n" + points(1);
  cl::ClReader reader(text, "part.apt");
  post::BlocksAhead blocks(reader);
  ASSERT_TRUE(blocks.next());
  EXPECT_EQ(blocks.ahead().size(), 2U) << "no farther than the tool change";
  ASSERT_TRUE(blocks.next());
  ASSERT_TRUE(blocks.next());
  EXPECT_EQ(blocks.ahead().front().kind, BlockKind::kTool);
  EXPECT_EQ(blocks.ahead().size(), 2U);
  ASSERT_TRUE(blocks.next());
  const auto error = blocks.next();
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().line, 7U);
}

/// From the pole to a tilt that the joint has on one side alone: the branch is chosen at the begin.
TEST(BlocksAhead, LetAProgramBeginOnTheBranchThatCarriesIt) {
  MachineModel model = test::shipped("trunnion-bc");
  for (int i = 0; i < model.joint_count; ++i) {
    if (model.joints[i].name == "B") model.joints[i].limits.travel_min = units::rad_from_deg(-10);
  }
  for (const double azimuth : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}) {
    std::string text = "UNITS/MM\nMULTAX/ON\nFEDRAT/600,MMPM\nGOTO/0,0,50,0,0,1\n";
    for (int n = 1; n <= 6; ++n) {
      const double tilt = units::rad_from_deg(5.0 * n);
      text += "GOTO/" + std::to_string(n) + ",0,50," +
              std::to_string(std::sin(tilt) * std::cos(azimuth)) + "," +
              std::to_string(std::sin(tilt) * std::sin(azimuth)) + "," +
              std::to_string(std::cos(tilt)) + "\n";
    }
    const auto program = test::written(text + "FINI\n", model);
    EXPECT_TRUE(program) << azimuth << ": " << (program ? "" : program.error().message);
  }
}

}  // namespace
}  // namespace meridian
