// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/calibrate/rotary_centres.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian::inspect {
namespace {

constexpr double kSphere_mm = 12.5, kProbeBall_mm = 3, kProbeLength_mm = 120;

const char* const kMachines[] = {"trunnion-ac", "head-table-bc", "fork-ca"};

std::string file_of(const std::string& name) {
  return std::string(MERIDIAN_SOURCE_DIR "/deploy/machines/") + name + ".toml";
}

/// The machine as it is: its rotary axes lie up to 0.5 mm beside where the file says.
MachineModel moved(const MachineModel& file, std::mt19937_64& engine) {
  std::uniform_real_distribution<double> error(-0.5, 0.5);
  auto chain = file.chain.chain;
  for (ChainJoint& joint : chain) {
    if (!joint.is_rotary) continue;
    const Vector3 by(error(engine), error(engine), error(engine));
    joint.point_mm += by - by.dot(joint.direction) * joint.direction;
  }
  MachineModel out = file;
  out.chain = *describe_chain(chain, file.chain.home_axis, file.chain.gauge_mm);
  return out;
}

/// Touches of a sphere on the table of `real`, from `sides` sides at each of these angles.
std::vector<Touch> touches_of(const MachineModel& real, std::mt19937_64& engine, double noise_mm,
                              const std::vector<std::array<double, 2>>& angles) {
  std::normal_distribution<double> draw(0, 1);
  std::vector<Touch> touches;
  const Vector3 sphere(30, -20, 60);
  for (const auto& [first, second] : angles) {
    for (int side = 0; side < 6; ++side) {
      Touch touch;
      touch.tool_length_mm = kProbeLength_mm;
      touch.radius_mm = kProbeBall_mm;
      touch.is_ball = true;
      std::size_t at = 0;
      for (const ChainJoint& joint : real.chain.chain) {
        if (joint.is_rotary) {
          touch.joints[static_cast<std::size_t>(joint.joint)] = at++ == 0 ? first : second;
        }
      }
      const Vector3 out = Vector3(draw(engine), draw(engine), draw(engine)).normalized();
      const Vector3 ball = sphere + (kSphere_mm + kProbeBall_mm + noise_mm * draw(engine)) * out;
      // With the angles as they are the ball is linear in the linear joints.
      const ToolPose zero = pose_of(touch, real);
      const Vector3 from = zero.tip + kProbeBall_mm * zero.axis;
      Eigen::Matrix3d slopes;
      std::array<std::size_t, 3> linear{};
      Eigen::Index column = 0;
      for (const ChainJoint& joint : real.chain.chain) {
        if (joint.is_rotary) continue;
        const auto i = static_cast<std::size_t>(joint.joint);
        Touch one = touch;
        one.joints[i] = 1;
        slopes.col(column) = pose_of(one, real).tip - zero.tip;
        linear[static_cast<std::size_t>(column++)] = i;
      }
      const Vector3 by = slopes.colPivHouseholderQr().solve(ball - from);
      for (std::size_t i = 0; i < 3; ++i)
        touch.joints[linear[i]] = by[static_cast<Eigen::Index>(i)];
      touch.toward = -out;
      touches.push_back(touch);
    }
  }
  return touches;
}

const std::vector<std::array<double, 2>> kManyAngles{
    {0, 0}, {1.5, 0}, {3, 0}, {-1.5, 0}, {0.4, 0.6}, {2, -0.6}, {-1, 0.5}, {-2.4, -0.5}};

/// How far the axis that was found is beside the one that is.
double error_of(const RotaryCentre& found, const MachineModel& real) {
  for (const ChainJoint& joint : real.chain.chain) {
    if (real.joints[static_cast<std::size_t>(joint.joint)].name != found.joint) continue;
    const Vector3 by = found.after_mm - joint.point_mm;
    return (by - by.dot(joint.direction) * joint.direction).norm();
  }
  ADD_FAILURE() << "no joint " << found.joint;
  return 1e9;
}

TEST(RotaryCentres, AreFoundWithinAMicrometreWhereTouchesHaveNoNoise) {
  std::mt19937_64 engine(20261127);
  for (const char* name : kMachines) {
    SCOPED_TRACE(name);
    const MachineModel file = config::load_machine(file_of(name));
    for (int n = 0; n < 10; ++n) {
      const MachineModel real = moved(file, engine);
      const auto found =
          find_rotary_centres(file, touches_of(real, engine, 0, kManyAngles), std::nullopt);
      ASSERT_TRUE(found) << found.error();
      for (const RotaryCentre& centre : found->centres) {
        if (!centre.is_determined) continue;
        EXPECT_LT(error_of(centre, real), 1e-3) << centre.joint;
      }
      EXPECT_NEAR(found->sphere_radius_mm, kSphere_mm, 1e-3);
      EXPECT_LT(found->largest_mm, 1e-6);
    }
  }
}

TEST(RotaryCentres, OfATableAreAllDetermined) {
  std::mt19937_64 engine(5);
  const MachineModel file = config::load_machine(file_of("trunnion-ac"));
  const auto found = find_rotary_centres(
      file, touches_of(moved(file, engine), engine, 0, kManyAngles), kSphere_mm);
  ASSERT_TRUE(found) << found.error();
  EXPECT_TRUE(found->is_determined());
}

TEST(RotaryCentres, AreFoundWithinTheStatedDeviationWhereTouchesAreNoisy) {
  constexpr double kNoise_mm = 0.005;
  std::mt19937_64 engine(11);
  const MachineModel file = config::load_machine(file_of("trunnion-ac"));
  int within = 0, all = 0;
  for (int n = 0; n < 50; ++n) {
    const MachineModel real = moved(file, engine);
    const auto found =
        find_rotary_centres(file, touches_of(real, engine, kNoise_mm, kManyAngles), kSphere_mm);
    ASSERT_TRUE(found) << found.error();
    EXPECT_NEAR(found->rms_mm, kNoise_mm, 0.5 * kNoise_mm);
    for (const RotaryCentre& centre : found->centres) {
      const double error = error_of(centre, real);
      EXPECT_LT(error, 5 * centre.deviation_mm);
      within += error < 2.5 * centre.deviation_mm ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GT(within, 0.9 * all) << "of two directions, 2.5 deviations hold 96 %";
}

TEST(RotaryCentres, ThatTheTouchesLeaveOpenStayAndAreReported) {
  std::mt19937_64 engine(9);
  const MachineModel file = config::load_machine(file_of("trunnion-ac"));
  const MachineModel real = moved(file, engine);
  const auto found = find_rotary_centres(
      file, touches_of(real, engine, 0, {{0, 0}, {1.5, 0}, {3, 0}, {-1.5, 0}}), std::nullopt);
  ASSERT_TRUE(found) << found.error();
  EXPECT_FALSE(found->is_determined()) << "A was never turned";
  const RotaryCentre& a = found->centres[1];
  EXPECT_EQ(a.joint, "A");
  EXPECT_EQ(a.after_mm, a.before_mm);
  EXPECT_NE(to_text(*found).find("A        point 0.0000 0.0000 -40.0000 mm stays: WARNING"),
            std::string::npos)
      << to_text(*found);
}

TEST(RotaryCentres, AreRefusedWhereTheyCannotBeFound) {
  std::mt19937_64 engine(1);
  const MachineModel file = config::load_machine(file_of("trunnion-ac"));
  auto touches = touches_of(file, engine, 0, {{0, 0}});
  EXPECT_FALSE(find_rotary_centres(file, touches, std::nullopt)) << "too few";
  touches = touches_of(file, engine, 0, kManyAngles);
  touches[3].is_ball = false;
  EXPECT_FALSE(find_rotary_centres(file, touches, std::nullopt)) << "not by a ball";
  EXPECT_FALSE(find_rotary_centres(config::load_machine(file_of("lai")), touches, std::nullopt));
}

TEST(RotaryCentres, AreWrittenIntoAFileThatIsElseTheSame) {
  std::mt19937_64 engine(2);
  const MachineModel file = config::load_machine(file_of("trunnion-ac"));
  const MachineModel real = moved(file, engine);
  const auto found =
      find_rotary_centres(file, touches_of(real, engine, 0, kManyAngles), std::nullopt);
  ASSERT_TRUE(found) << found.error();
  std::stringstream text;
  text << std::ifstream(file_of("trunnion-ac")).rdbuf();
  const auto written = with_centres(text.str(), *found);
  ASSERT_TRUE(written) << written.error();
  const MachineModel back = config::parse_machine(*written, "new");
  for (const RotaryCentre& centre : found->centres) EXPECT_LT(error_of(centre, back), 1e-12);
  std::istringstream old_lines(text.str()), new_lines(*written);
  int changed = 0;
  for (std::string a, b; std::getline(old_lines, a) && std::getline(new_lines, b);) {
    changed += a != b ? 1 : 0;
    EXPECT_TRUE(a == b || b.starts_with("point_mm = [")) << b;
  }
  EXPECT_EQ(changed, 2);
  EXPECT_FALSE(with_centres("[joints.C]\npoint_mm = [0, 0, 0]\n", *found)) << "A is not there";
}

}  // namespace
}  // namespace meridian::inspect
