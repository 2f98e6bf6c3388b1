// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/calibrate/touches.hpp"

#include <gtest/gtest.h>

#include <random>

namespace meridian::inspect {
namespace {

TEST(Touches, ComeBackBitForBit) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> draw(-1e4, 1e4);
  std::string text = touch_header() + "# the vice\n\n";
  std::vector<Touch> touches;
  for (int n = 0; n < 100; ++n) {
    Touch touch;
    for (double& joint : touch.joints) joint = draw(engine);
    touch.tool_length_mm = draw(engine);
    touch.radius_mm = std::abs(draw(engine));
    touch.is_ball = n % 2 == 0;
    touch.toward = Vector3(draw(engine), draw(engine), draw(engine)).normalized();
    touches.push_back(touch);
    text += to_row(touch);
  }
  const auto read = read_touches(text, "touches.csv");
  ASSERT_TRUE(read) << read.error();
  ASSERT_EQ(read->size(), touches.size());
  for (std::size_t i = 0; i < touches.size(); ++i) {
    EXPECT_EQ((*read)[i].joints, touches[i].joints);
    EXPECT_EQ((*read)[i].tool_length_mm, touches[i].tool_length_mm);
    EXPECT_EQ((*read)[i].radius_mm, touches[i].radius_mm);
    EXPECT_EQ((*read)[i].is_ball, touches[i].is_ball);
    EXPECT_EQ((*read)[i].toward, touches[i].toward);
  }
}

TEST(Touches, AreRefusedByLineWhereARowIsNone) {
  const std::string good = "0,0,0,0,0,0,110,5,1,0,0,-1\n";
  EXPECT_TRUE(read_touches(good, "t.csv"));
  for (const char* bad : {"0,0,0,0,0,0,110,5,1,0,0\n", "0,0,0,0,0,0,110,5,1,0,0,-1,2\n",
                          "0,0,0,0,0,0,110,x,1,0,0,-1\n", "0,0,0,0,0,nan,110,5,1,0,0,-1\n",
                          "0,0,0,0,0,0,110,-5,1,0,0,-1\n", "0,0,0,0,0,0,110,5,1,0,0,-2\n"}) {
    const auto read = read_touches(good + bad, "t.csv");
    ASSERT_FALSE(read) << bad;
    EXPECT_EQ(read.error().find("t.csv:2: "), 0U) << read.error();
  }
}

}  // namespace
}  // namespace meridian::inspect
