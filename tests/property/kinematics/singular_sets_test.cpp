// SPDX-License-Identifier: Apache-2.0
// Every shipped machine at, near and off every set where it is singular, robots in every
// combination of their three: the joints that solve() finds on every branch, from any reference,
// give tip and axis back. Travel is left out: the law is one of the closed forms.
#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <random>

#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian {
namespace {

constexpr double kTip_mm = 1e-9;
constexpr double kAxis = 1e-12;
constexpr int kPoses = 10'000;
constexpr unsigned kSeed = 20261121;
constexpr double kPi = std::numbers::pi;

const std::filesystem::path kFolder = MERIDIAN_SOURCE_DIR "/deploy/machines";

std::vector<std::string> shipped_machines() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

enum class Aim { kAt, kNear, kOff };

/// Draws joints that put a machine where it is singular.
class Marksman {
 public:
  [[nodiscard]] double draw(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  /// An angle at `singular`, within 1e-1 to 1e-13 rad of it on either side, or anywhere.
  [[nodiscard]] double aimed(double singular, Aim aim) {
    if (aim == Aim::kOff) return draw(-kPi, kPi);
    if (aim == Aim::kAt) return singular;
    return singular + (draw(-1, 1) < 0 ? -1 : 1) * std::pow(10.0, draw(-13, -1));
  }

  [[nodiscard]] JointVector joints(const MachineModel& model, int n) {
    return model.family == MachineFamily::kRobot ? of_robot(model, n) : of_chain(model, n);
  }

  /// The joints themselves, or some others.
  [[nodiscard]] JointVector reference(const MachineModel& model, const JointVector& q, int n) {
    if (n % 5 == 0) return q;
    JointVector out{};
    for (int i = 0; i < model.joint_count; ++i) out[i] = draw(-7, 7);
    return out;
  }

 private:
  /// Chains and the Lai machine: joint b decides, singular where the tool axis lies in the plane of
  /// both rotary axes. Those two places are the poles or the two ends of reach.
  [[nodiscard]] JointVector of_chain(const MachineModel& model, int n) {
    JointVector q{};
    for (int i = 0; i < model.joint_count; ++i) {
      q[i] = model.joints[i].is_rotary ? draw(-2 * kPi, 2 * kPi) : draw(-800, 800);
    }
    const double end = n % 2 == 0 ? 0 : kPi;
    const auto aim = static_cast<Aim>(n % 3);
    if (model.family == MachineFamily::kLai) {
      q[lai::kTheta2] = aimed(end, aim);
    } else {
      const ChainKinematics& k = model.chain;
      q[k.b.joint] = k.b.sign * aimed(end - std::atan2(k.b0_sin, k.b0_cos), aim);
    }
    return q;
  }

  /// Robots: wrist point on the base axis, arm stretched or folded, wrist aligned; each at, near or
  /// off, in all 27 combinations.
  [[nodiscard]] JointVector of_robot(const MachineModel& model, int n) {
    const RobotKinematics& k = model.robot;
    JointVector q{};
    for (int i = 0; i < model.joint_count; ++i) q[i] = draw(-2 * kPi, 2 * kPi);
    const bool is_other = draw(-1, 1) < 0;
    q[robot::kElbow] = aimed(draw(-1, 1) < 0 ? 0 : kPi, static_cast<Aim>(n % 3));
    const double over_base = std::atan2(k.upper_arm_mm + k.forearm_mm * std::cos(q[robot::kElbow]),
                                        k.forearm_mm * std::sin(q[robot::kElbow]));
    q[robot::kShoulder] = aimed(over_base + (is_other ? kPi : 0), static_cast<Aim>(n / 3 % 3));
    const auto wrist = static_cast<Aim>(n / 9 % 3);
    if (k.has_spherical_wrist) {
      q[robot::kBend] = aimed(draw(-1, 1) < 0 ? 0 : kPi, wrist);
    } else {
      q[robot::kTilt] = aimed(draw(-1, 1) < 0 ? -kPi / 2 : kPi / 2, wrist);
    }
    return q;
  }

  std::mt19937_64 random_{kSeed};
};

/// What solutions made of the law, in what is allowed.
struct Worst {
  double tip_mm = 0, axis = 0;
  int held = 0, flat = 0;

  static double longest(const JointVector& q) {
    double max = 0;
    for (const double joint : q) max = std::max(max, std::abs(joint));
    return max;
  }

  /// Of the directions of the linear joints.
  static double volume(const MachineModel& model, const JointVector& q) {
    if (model.family != MachineFamily::kChain) return 1;
    const ChainKinematics& k = model.chain;
    const SinCos<double> a = sin_cos(k.a.sign * q[k.a.joint]);
    const SinCos<double> b = sin_cos(k.b.sign * q[k.b.joint]);
    const auto direction = [&](int i) { return chain::column(k, i, a, b); };
    return std::abs(chain::scalar_product(direction(0), chain::cross(direction(1), direction(2))));
  }

  void check(const MachineModel& model, const ToolPose& pose, int branch,
             const JointVector& reference) {
    const auto at = solve(model, model.tool_length_mm, pose, branch, reference);
    // Slides that lie in one plane, or nearly so that the other branch asks for kilometres of them.
    const bool is_unable = at.status == SolveStatus::kUnreachable;
    if ((is_unable && volume(model, at.q) < chain::kMinVolume) || longest(at.q) > 1e5) {
      ++flat;
      return;
    }
    ASSERT_NE(at.status, SolveStatus::kUnreachable) << "branch " << branch;
    const bool is_robot = model.family == MachineFamily::kRobot;
    double allowed = kAxis;
    if (at.status == SolveStatus::kAtPole) {  // the axis is the nearest one, within the hold
      allowed += is_robot ? robot::kWristHold_rad : kPoleHold_rad;
      ++held;
    }
    const ToolPose back = forward(model, model.tool_length_mm, at.q);
    tip_mm = std::max(tip_mm, (back.tip - pose.tip).norm());
    axis = std::max(axis, (back.axis - pose.axis).norm() / allowed);
  }
};

class SingularSets : public testing::TestWithParam<std::string> {};

TEST_P(SingularSets, GiveTipAndAxisBackOnEveryBranchFromAnyReference) {
  RecordProperty("seed", static_cast<int>(kSeed));
  const MachineModel model = config::load_machine(kFolder / (GetParam() + ".toml"));
  Marksman marksman;
  Worst worst;
  for (int n = 0; n < kPoses; ++n) {
    SCOPED_TRACE(n);
    const JointVector q = marksman.joints(model, n);
    const JointVector reference = marksman.reference(model, q, n);
    const ToolPose pose = forward(model, model.tool_length_mm, q);
    for (int branch = 0; branch < branch_count(model); ++branch) {
      ASSERT_NO_FATAL_FAILURE(worst.check(model, pose, branch, reference));
    }
  }
  EXPECT_LE(worst.tip_mm, kTip_mm);
  EXPECT_LE(worst.axis, 1.0);
  EXPECT_GT(worst.held, 1000);
  EXPECT_EQ(worst.flat, 0);
  std::printf("%s: tip %.1e mm, axis %.1e of what is allowed, %d held\n", GetParam().c_str(),
              worst.tip_mm, worst.axis, worst.held);
}

INSTANTIATE_TEST_SUITE_P(Shipped, SingularSets, testing::ValuesIn(shipped_machines()),
                         [](const auto& machine) {
                           std::string name = machine.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

/// A machine nobody built: the joints in any order, directions along the axes, at 45 degrees
/// between them, or any; nullopt where the draw is none that can work.
std::optional<MachineModel> drawn_machine(Marksman& marksman, int n) {
  const auto direction = [&]() -> Vector3 {
    Vector3 v;
    do {
      for (int i = 0; i < 3; ++i) {
        v[i] = n % 3 == 2 ? marksman.draw(-1, 1) : std::round(marksman.draw(-1.4, 1.4));
      }
    } while (v.norm() < 0.1 || (n % 3 == 0 && v.norm() > 1.1));
    return v.normalized();
  };
  const auto point = [&] {
    return Vector3(marksman.draw(-300, 300), marksman.draw(-300, 300), marksman.draw(-300, 300));
  };
  std::array<int, 5> order{0, 1, 2, 3, 4};
  for (std::size_t i = 4; i > 0; --i) {
    std::swap(order[i],
              order[static_cast<std::size_t>(marksman.draw(0, static_cast<double>(i + 1)))]);
  }
  const double table = marksman.draw(-0.5, 5.5);
  MachineModel model;
  model.family = MachineFamily::kChain;
  model.tool_length_mm = 110;
  std::array<ChainJoint, 5> chain;
  for (std::size_t i = 0; i < 5; ++i) {
    const bool is_rotary = order[i] >= 3;
    chain[i] = {order[i], is_rotary, static_cast<double>(i) < table, direction(), point()};
    model.joints[static_cast<std::size_t>(order[i])].is_rotary = is_rotary;
  }
  const auto described = describe_chain(chain, direction(), point());
  if (!described) return std::nullopt;
  model.chain = *described;
  return model;
}

TEST(AnyChain, GivesTipAndAxisBackAtNearAndOffItsSingularSets) {
  constexpr int kMachines = 300, kPosesEach = 100;
  Marksman marksman;
  Worst worst;
  int machines = 0;
  for (int n = 0; machines < kMachines; ++n) {
    const auto model = drawn_machine(marksman, n);
    if (!model) continue;
    ++machines;
    for (int pose_number = 0; pose_number < kPosesEach; ++pose_number) {
      SCOPED_TRACE(testing::Message() << "machine " << n << " pose " << pose_number);
      const JointVector q = marksman.joints(*model, pose_number);
      const ToolPose pose = forward(*model, model->tool_length_mm, q);
      const JointVector reference = marksman.reference(*model, q, pose_number);
      for (int branch = 0; branch < 2; ++branch) {
        ASSERT_NO_FATAL_FAILURE(worst.check(*model, pose, branch, reference));
      }
    }
  }
  EXPECT_LE(worst.tip_mm, kTip_mm);
  EXPECT_LE(worst.axis, 1.0);
  EXPECT_LT(worst.flat, kMachines * kPosesEach / 20);
  std::printf("%d machines: tip %.1e mm, axis %.1e of what is allowed, %d held, %d flat\n",
              machines, worst.tip_mm, worst.axis, worst.held, worst.flat);
}

}  // namespace
}  // namespace meridian
