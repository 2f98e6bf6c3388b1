// SPDX-License-Identifier: Apache-2.0
#include "service/machine/scene/bodies.hpp"

#include <gtest/gtest.h>

#include <set>

#include "service/machine/file/machine_file.hpp"
#include "support/shipped_machines.hpp"

namespace meridian::scene {
namespace {

class BodiesOf : public testing::TestWithParam<std::string> {};

TEST_P(BodiesOf, EveryLinkStandInItsFrameAndHaveASize) {
  const MachineModel model = config::load_machine(test::shipped_file(GetParam()));
  LinkFrames frames(model);
  std::set<std::string> names{LinkFrames::root()}, dressed;
  for (const LinkFrame& frame : frames.at(JointVector{}, 100)) names.insert(frame.name);
  for (const Body& body : bodies_of(model, frames, 100)) {
    EXPECT_TRUE(names.contains(body.frame)) << body.frame;
    EXPECT_GT(body.length_mm, 0);
    EXPECT_GT(body.width_mm, 0);
    EXPECT_NEAR(body.axis.norm(), 1, 1e-9);
    EXPECT_TRUE(body.centre_mm.allFinite());
    dressed.insert(body.frame);
  }
  for (const Screw& screw : frames.tree().head) {
    EXPECT_TRUE(dressed.contains(model.joints[screw.joint].name + "_link"));
  }
  for (const Screw& screw : frames.tree().table) {
    EXPECT_TRUE(dressed.contains(model.joints[screw.joint].name + "_link"));
  }
}

TEST_P(BodiesOf, ToolReachesFromTheTipToTheSpindle) {
  const MachineModel model = config::load_machine(test::shipped_file(GetParam()));
  const LinkFrames frames(model);
  const std::vector<Body> bodies = bodies_of(model, frames, 120);
  const Body& tool = bodies.back();
  EXPECT_EQ(tool.frame, "tool");
  EXPECT_EQ(tool.length_mm, 120);
  EXPECT_EQ(tool.centre_mm, Vector3(0, 0, 60));
}

INSTANTIATE_TEST_SUITE_P(Bodies, BodiesOf, testing::ValuesIn(test::shipped_machines()),
                         test::test_name);

}  // namespace
}  // namespace meridian::scene
