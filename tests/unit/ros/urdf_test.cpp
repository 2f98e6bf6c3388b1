// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/urdf.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <map>
#include <random>
#include <regex>
#include <sstream>

#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/shipped_machines.hpp"
#include "support/text_file.hpp"

namespace meridian::ros {
namespace {

/// A joint as a reader of URDF takes it from the text.
struct UrdfJoint {
  std::string name, type, parent, child;
  Vector3 xyz = Vector3::Zero(), rpy = Vector3::Zero(), axis = Vector3::UnitX();
};

[[nodiscard]] Vector3 vector(const std::string& text) {
  std::istringstream in(text);
  Vector3 out;
  in >> out.x() >> out.y() >> out.z();
  return out;
}

[[nodiscard]] std::string found(const std::string& text, const std::string& pattern) {
  std::smatch match;
  return std::regex_search(text, match, std::regex(pattern)) ? match[1].str() : "";
}

[[nodiscard]] std::vector<UrdfJoint> joints_of_text(const std::string& urdf) {
  std::vector<UrdfJoint> out;
  std::size_t at = 0;
  while ((at = urdf.find("<joint ", at)) != std::string::npos) {
    const std::string text = urdf.substr(at, urdf.find("</joint>", at) - at);
    UrdfJoint joint{found(text, "name=\"([^\"]*)\""), found(text, "type=\"([^\"]*)\""),
                    found(text, "parent link=\"([^\"]*)\""),
                    found(text, "child link=\"([^\"]*)\"")};
    joint.xyz = vector(found(text, "origin xyz=\"([^\"]*)\""));
    joint.rpy = vector(found(text, "rpy=\"([^\"]*)\""));
    if (joint.type != "fixed") joint.axis = vector(found(text, "axis xyz=\"([^\"]*)\""));
    out.push_back(joint);
    at += text.size();
  }
  return out;
}

/// Source: URDF, the element joint: origin, then the motion about or along the axis.
[[nodiscard]] Eigen::Isometry3d pose_of(const UrdfJoint& joint, double value) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = joint.xyz;
  pose.linear() = (Eigen::AngleAxisd(joint.rpy.z(), Vector3::UnitZ()) *
                   Eigen::AngleAxisd(joint.rpy.y(), Vector3::UnitY()) *
                   Eigen::AngleAxisd(joint.rpy.x(), Vector3::UnitX()))
                      .toRotationMatrix();
  if (joint.type == "prismatic") return pose * Eigen::Translation3d(value * joint.axis);
  if (joint.type == "fixed") return pose;
  return pose * Eigen::AngleAxisd(value, joint.axis);
}

class Urdf : public testing::TestWithParam<std::string> {
 protected:
  MachineModel model_ = config::load_machine(test::shipped_file(GetParam()).string());
  std::string text_ = urdf_of(model_);
};

TEST_P(Urdf, PutsTheToolWhereForwardKinematicsSays) {
  constexpr double kTolerance_m = 1e-9;  // 12 digits of metres
  const std::vector<UrdfJoint> joints = joints_of_text(text_);
  ASSERT_EQ(joints.size(), static_cast<std::size_t>(model_.joint_count) + 2) << "tool, workpiece";
  std::mt19937 engine(7);
  for (int draw = 0; draw < 20; ++draw) {
    JointVector q{};
    std::map<std::string, double> values;
    for (int i = 0; i < model_.joint_count; ++i) {
      const JointSpec& spec = model_.joints[static_cast<std::size_t>(i)];
      const double low = spec.is_endless ? -3 : spec.limits.travel_min;
      const double high = spec.is_endless ? 3 : spec.limits.travel_max;
      q[static_cast<std::size_t>(i)] = std::uniform_real_distribution(low, high)(engine);
      values[spec.name] = q[static_cast<std::size_t>(i)] * (spec.is_rotary ? 1 : 1e-3);
    }
    std::map<std::string, Eigen::Isometry3d> in_machine{{"machine", Eigen::Isometry3d::Identity()}};
    for (const UrdfJoint& joint : joints) {
      ASSERT_TRUE(in_machine.contains(joint.parent)) << joint.parent;
      const double value = joint.type == "fixed" ? 0 : values.at(joint.name);
      in_machine[joint.child] = in_machine[joint.parent] * pose_of(joint, value);
    }
    const Eigen::Isometry3d seen = in_machine.at("workpiece").inverse() * in_machine.at("tool");
    const Pose<double> wanted = forward(model_, model_.tool_length_mm, q);
    EXPECT_LT((seen.translation() - 1e-3 * wanted.tip).norm(), kTolerance_m);
    EXPECT_LT((seen.linear().col(2) - wanted.axis).norm(), kTolerance_m);
  }
}

TEST_P(Urdf, CheckUrdfFindsNothingWrong) {
  if (std::system("command -v check_urdf >/dev/null") != 0) {
    GTEST_SKIP() << "check_urdf (package liburdfdom-tools) is not there";
  }
  const test::TextFile file(text_, ".urdf"), errors("", ".err");
  const std::string command =
      "check_urdf " + file.path().string() + " >/dev/null 2>" + errors.path().string();
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(test::read_text(errors.path()), "");
}

INSTANTIATE_TEST_SUITE_P(Shipped, Urdf, testing::ValuesIn(test::shipped_machines()),
                         test::test_name);

TEST(UrdfText, NamesAreEscaped) {
  MachineModel model = config::load_machine(test::shipped_file("lai").string());
  model.name = "a<b>&\"c\"";
  EXPECT_NE(urdf_of(model).find("<robot name=\"a&lt;b&gt;&amp;&quot;c&quot;\">"),
            std::string::npos);
}

}  // namespace
}  // namespace meridian::ros
