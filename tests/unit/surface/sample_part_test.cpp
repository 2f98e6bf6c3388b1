// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/sample_part.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "service/programs/cl/cl_reader.hpp"

namespace meridian::surface {
namespace {

std::string made(const std::string& name) {
  std::ostringstream out;
  EXPECT_TRUE(write_sample(name, out));
  return out.str();
}

TEST(SamplePart, InDeployIsWhatTheGeneratorMakes) {
  for (const std::string& name : sample_names()) {
    std::ifstream in(MERIDIAN_SOURCE_DIR "/deploy/parts/" + name + ".apt", std::ios::binary);
    std::ostringstream shipped;
    shipped << in.rdbuf();
    EXPECT_EQ(made(name), shipped.str()) << "regenerate: meridian surface --sample " << name
                                         << " -o deploy/parts/" << name << ".apt";
  }
}

TEST(SamplePart, ReadsBackWithoutAWarning) {
  for (const std::string& name : sample_names()) {
    const std::string text = made(name);
    cl::ClReader reader(std::string_view(text), name);
    auto block = reader.next();
    while (block && *block) block = reader.next();
    ASSERT_TRUE(block) << block.error().text();
    EXPECT_TRUE(reader.warnings().empty());
  }
}

TEST(SamplePart, OfAnUnknownNameIsNotMade) {
  std::ostringstream out;
  EXPECT_FALSE(write_sample("nothing", out));
  EXPECT_EQ(out.str(), "");
}

TEST(Blossom, LiesOnItsDomeWithTheToolAlongTheNormal) {
  for (const ClBlock& block : blossom()) {
    if (block.kind != BlockKind::kCut) continue;
    const Vector3 from_centre = to_vector(block.tip_mm) + Vector3{0, 0, 100};
    EXPECT_NEAR(from_centre.norm(), 100, 1e-12);
    EXPECT_LT((from_centre.normalized() - to_vector(block.axis)).norm(), 1e-14);
  }
}

TEST(Blossom, PassesThePoleStraightOnAndTiltsTo35Degrees) {
  const std::string text = made("blossom");
  cl::ClReader reader(std::string_view(text), "blossom");
  int at_pole = 0;
  double turn_at_pole = 0;
  ClBlock before{};
  ClBlock middle{};
  for (auto block = reader.next(); block && *block; block = reader.next()) {
    if (middle.axis == Array3{0, 0, 1} && middle.kind == BlockKind::kCut &&
        (*block)->kind == BlockKind::kCut && before.kind == BlockKind::kCut) {
      ++at_pole;
      const double in = std::atan2(before.axis[1], before.axis[0]);
      const double out = std::atan2((*block)->axis[1], (*block)->axis[0]);
      turn_at_pole = std::max(
          turn_at_pole, std::abs(std::remainder(out - in - std::acos(-1.0), 2 * std::acos(-1.0))));
    }
    before = middle;
    middle = **block;
  }
  EXPECT_EQ(at_pole, 3);
  EXPECT_LT(turn_at_pole, 0.1);  // rad; two blocks worth of C
  EXPECT_NEAR(reader.summary().tilt_max_rad, std::asin(0.57), 1e-8);
  EXPECT_GT(reader.summary().blocks, 140U);
}

}  // namespace
}  // namespace meridian::surface
