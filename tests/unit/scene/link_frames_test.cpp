// SPDX-License-Identifier: Apache-2.0
#include "service/machine/scene/link_frames.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/shipped_machines.hpp"

namespace meridian::scene {
namespace {

/// Poses in the root's frame, out of parents and children alone.
[[nodiscard]] std::map<std::string, Eigen::Isometry3d> in_root(
    const std::vector<LinkFrame>& frames) {
  std::map<std::string, Eigen::Isometry3d> out{{LinkFrames::root(), Eigen::Isometry3d::Identity()}};
  for (const LinkFrame& frame : frames) {
    EXPECT_TRUE(out.contains(frame.parent)) << frame.parent << " comes behind " << frame.name;
    out[frame.name] = out[frame.parent] * frame.pose;
  }
  return out;
}

class OfEveryMachine : public testing::TestWithParam<std::string> {};

TEST_P(OfEveryMachine, ToolStandsInTheWorkpieceWhereForwardKinematicsSays) {
  const MachineModel model = config::load_machine(test::shipped_file(GetParam()));
  LinkFrames frames(model);
  std::mt19937_64 engine(7);
  for (int n = 0; n < 50; ++n) {
    JointVector q{};
    for (int i = 0; i < model.joint_count; ++i) {
      const JointSpec& joint = model.joints[static_cast<std::size_t>(i)];
      const double low = joint.is_endless ? -20 : joint.limits.travel_min;
      const double high = joint.is_endless ? 20 : joint.limits.travel_max;
      q[static_cast<std::size_t>(i)] = std::uniform_real_distribution<double>(low, high)(engine);
    }
    const double tool = std::uniform_real_distribution<double>(20, 200)(engine);
    auto poses = in_root(frames.at(q, tool));
    const Eigen::Isometry3d seen = poses["workpiece"].inverse() * poses["tool"];
    const Pose<double> wanted = forward(model, tool, q);
    EXPECT_LT((seen.translation() - wanted.tip).norm(), 1e-9);
    EXPECT_LT((seen.linear().col(2) - wanted.axis).norm(), 1e-12);
    const Vector3 over_base = to_vector(tip_over_base(model, tool, q));
    EXPECT_LT((poses["tool"].translation() - over_base).norm(), 1e-9);
  }
}

TEST_P(OfEveryMachine, FramesHaveNamesOfTheirOwn) {
  LinkFrames frames(config::load_machine(test::shipped_file(GetParam())));
  std::set<std::string> names{LinkFrames::root()};
  for (const LinkFrame& frame : frames.at(JointVector{}, 100)) {
    EXPECT_TRUE(names.insert(frame.name).second) << frame.name;
  }
}

INSTANTIATE_TEST_SUITE_P(LinkFrames, OfEveryMachine, testing::ValuesIn(test::shipped_machines()),
                         test::test_name);

TEST(ToolRotation, TakesZToTheToolAxis) {
  for (const Vector3& wanted : {Vector3(0, 0, 1), Vector3(0.6, 0, 0.8), Vector3(0, -1, 0),
                                Vector3(0.48, 0.6, -0.64), Vector3(0, 0, -1)}) {
    const Eigen::Quaterniond rotation = from_z_to(wanted);
    EXPECT_NEAR(rotation.norm(), 1, 1e-15);
    EXPECT_LT((rotation * Vector3::UnitZ() - wanted).norm(), 1e-15);
  }
}

}  // namespace
}  // namespace meridian::scene
