// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "meridian/kinematics/jacobian.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"

namespace meridian {
namespace {

using Joint = ChainJoint;

/// The machine of Lai et al. as a chain: theta1 about z, b2 along y, b3 along x, b4 along -z,
/// theta2 about y through (0, 0, h).
MachineModel lai_as_chain(const MachineModel& lai) {
  MachineModel model = lai;
  model.family = MachineFamily::kChain;
  const std::array<Joint, 5> chain{
      Joint{3, true, false, Vector3::UnitZ(), Vector3::Zero()},
      Joint{1, false, false, Vector3::UnitY(), Vector3::Zero()},
      Joint{0, false, false, Vector3::UnitX(), Vector3::Zero()},
      Joint{2, false, false, -Vector3::UnitZ(), Vector3::Zero()},
      Joint{4, true, false, Vector3::UnitY(), Vector3(0, 0, lai.lai.h_mm)}};
  model.chain = *describe_chain(chain, Vector3::UnitZ(),
                                Vector3(0, -lai.lai.e_mm, lai.lai.h_mm - lai.lai.pivot_mm));
  return model;
}

TEST(Chain, TheLaiMachineIsAMember) {
  const MachineModel lai = test::lai_machine();
  const MachineModel chain = lai_as_chain(lai);
  std::mt19937_64 random{7};
  const auto draw = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int n = 0; n < 10'000; ++n) {
    const double tilt = (n % 2 == 0 ? 1.0 : -1.0) * draw(0.01, 1.0);
    const JointVector q{draw(-500, 500), draw(-500, 500), draw(-500, 500), draw(-3, 3), tilt};
    const ToolPose pose = forward(lai, 110, q);
    const ToolPose same = forward(chain, 110, q);
    ASSERT_LT((pose.tip - same.tip).norm(), 1e-11);
    ASSERT_LT((pose.axis - same.axis).norm(), 1e-14);
    for (int branch = 0; branch < 2; ++branch) {
      const auto a = solve(lai, 110, pose, branch, q);
      const auto b = solve(chain, 110, pose, branch, q);
      const auto c = solve(chain, 110, pose, 1 - branch, q);
      for (int i = 0; i < 5; ++i) {
        const auto off = [&](double x) {  // half a turn from the reference either winding is right
          return std::abs(i < 3 ? x : std::remainder(x, 2 * std::numbers::pi));
        };
        const double apart = std::min(off(a.q[i] - b.q[i]), off(a.q[i] - c.q[i]));
        // a C angle off by eps/sin(tilt) moves slides 500 mm away from the axis by 500 times that
        ASSERT_LT(apart, i < 3 ? 1e-10 : 1e-12) << n << " joint " << i;
      }
    }
    ASSERT_NEAR(measure(chain, q), measure(lai, q), 1e-14);
  }
}

TEST(Chain, HoldsItsRedundantJointOnThePoleWithTheTipExact) {
  const MachineModel chain = lai_as_chain(test::lai_machine());
  JointVector reference{};
  reference[3] = 1.25;
  const ToolPose pose{Vector3(10, 20, 30), Vector3::UnitZ()};
  const auto at = solve(chain, 110, pose, 0, reference);
  EXPECT_EQ(at.status, SolveStatus::kAtPole);
  EXPECT_EQ(at.q[3], 1.25);
  EXPECT_LT((forward(chain, 110, at.q).tip - pose.tip).norm(), 1e-12);
}

struct Nonsense {
  const char* name;
  std::array<Joint, 5> chain;
  Vector3 axis;
  const char* reason;
};

TEST(Chain, NonsenseIsRefusedWithItsReason) {
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ(),
                o = Vector3::Zero();
  const Nonsense cases[] = {{"parallel",
                             {Joint{0, true, true, z, o},
                              {1, true, true, z, o},
                              {2, false, false, x, o},
                              {3, false, false, y, o},
                              {4, false, false, z, o}},
                             z,
                             "parallel"},
                            {"cannot tilt",
                             {Joint{0, true, true, z, o},
                              {1, true, true, x, o},
                              {2, false, false, x, o},
                              {3, false, false, y, o},
                              {4, false, false, z, o}},
                             x,
                             "tool axis"},
                            {"flat",
                             {Joint{0, true, true, z, o},
                              {1, true, true, x, o},
                              {2, false, false, x, o},
                              {3, false, false, y, o},
                              {4, false, false, y, o}},
                             z,
                             "span"},
                            {"three rotary",
                             {Joint{0, true, true, z, o},
                              {1, true, true, x, o},
                              {2, true, false, y, o},
                              {3, false, false, y, o},
                              {4, false, false, z, o}},
                             z,
                             "two rotary"}};
  for (const Nonsense& wrong : cases) {
    const auto described = describe_chain(wrong.chain, wrong.axis, o);
    ASSERT_FALSE(described) << wrong.name << " was accepted";
    EXPECT_NE(described.error().find(wrong.reason), std::string::npos) << described.error();
  }
}

}  // namespace
}  // namespace meridian
