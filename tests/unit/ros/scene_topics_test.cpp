// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <map>

#include "meridian/kinematics/kinematics.hpp"
#include "service/neighbours/ros/topics/marker_topic.hpp"
#include "service/neighbours/ros/topics/transform_topic.hpp"
#include "support/machines.hpp"
#include "support/mcap_reading.hpp"
#include "support/text_file.hpp"

namespace meridian::ros {
namespace {

using test::CdrParts;
using test::TextFile;

class SceneTopics : public testing::Test {
 protected:
  SceneTopics() : writer_(std::move(*mcap::Writer::create(file_.path(), {}))) {}
  [[nodiscard]] std::vector<test::McapMessage> messages(const std::string& topic) {
    EXPECT_TRUE(writer_->close());
    std::vector<test::McapMessage> out;
    for (auto& message : test::read_mcap(test::read_text(file_.path())).messages) {
      if (message.topic == topic) out.push_back(message);
    }
    return out;
  }

  TextFile file_{"", ".mcap"};
  MachineModel model_ = test::lai_machine();
  std::unique_ptr<mcap::Writer> writer_;
};

/// Reads x, y, z.
[[nodiscard]] Vector3 vector(CdrParts& parts) {
  Vector3 out;
  for (double& value : out) value = parts.number<double>();
  return out;
}
[[nodiscard]] Eigen::Quaterniond quaternion(CdrParts& parts) {
  Eigen::Quaterniond out;
  for (double& value : out.coeffs()) value = parts.number<double>();
  return out;
}

TEST_F(SceneTopics, TransformsPutTheToolWhereForwardKinematicsSays) {
  TransformTopic topic(*writer_, model_);
  const JointVector q{12, -34, 56, 0.7, -0.3};
  topic.write(0, q);
  topic.write(39'000'000, q);
  topic.write(40'000'000, q);
  const auto all = messages("/tf");
  ASSERT_EQ(all.size(), 2U) << "twenty-five a second";
  CdrParts parts(all[0].data);
  std::map<std::string, Eigen::Isometry3d> in_machine{{"machine", Eigen::Isometry3d::Identity()}};
  const auto count = parts.number<std::uint32_t>();
  EXPECT_EQ(count, 7U) << "five links, tool and workpiece";
  for (std::uint32_t i = 0; i < count; ++i) {
    (void)parts.number<std::int32_t>();
    (void)parts.number<std::uint32_t>();
    const std::string parent = parts.text(), name = parts.text();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = vector(parts);
    pose.linear() = quaternion(parts).normalized().toRotationMatrix();
    in_machine[name] = in_machine.at(parent) * pose;
  }
  EXPECT_TRUE(parts.is_over());
  const Eigen::Isometry3d seen = in_machine.at("workpiece").inverse() * in_machine.at("tool");
  const Pose<double> wanted = forward(model_, model_.tool_length_mm, q);
  EXPECT_LT((seen.translation() - 1e-3 * wanted.tip).norm(), 1e-5);
  EXPECT_LT((seen.linear().col(2) - wanted.axis).norm(), 1e-5);
}

/// What stands behind the points of a marker.
void expect_end(CdrParts& parts) {
  EXPECT_EQ(parts.number<std::uint32_t>(), 0U) << "colours";
  EXPECT_EQ(parts.text(), "") << "texture";
  (void)parts.number<std::int32_t>();
  (void)parts.number<std::uint32_t>();
  EXPECT_EQ(parts.text() + parts.text(), "");
  EXPECT_EQ(parts.number<std::uint32_t>(), 0U);
  EXPECT_EQ(parts.number<std::uint32_t>(), 0U);
  EXPECT_EQ(parts.text() + parts.text() + parts.text(), "");
  EXPECT_EQ(parts.number<std::uint32_t>(), 0U);
  EXPECT_EQ(parts.number<std::uint8_t>(), 0U);
}

/// Reads what stands in front of the points. Returns the frame.
[[nodiscard]] std::string read_front(CdrParts& parts, std::int32_t& type) {
  (void)parts.number<std::int32_t>();
  (void)parts.number<std::uint32_t>();
  const std::string frame = parts.text();
  (void)parts.text();
  (void)parts.number<std::int32_t>();
  type = parts.number<std::int32_t>();
  EXPECT_EQ(parts.number<std::int32_t>(), 0) << "added";
  EXPECT_LT(vector(parts).norm(), 5.0) << "m, not mm";
  EXPECT_NEAR(quaternion(parts).norm(), 1, 1e-12);
  EXPECT_GT(vector(parts).x(), 0);
  for (int i = 0; i < 4; ++i) EXPECT_LE(parts.number<float>(), 1.0F);
  EXPECT_EQ(parts.number<std::int32_t>(), 0);
  EXPECT_EQ(parts.number<std::uint32_t>(), 0U);
  EXPECT_EQ(parts.number<std::uint8_t>(), 1U) << "locked to its frame";
  return frame;
}

TEST_F(SceneTopics, BodiesOfTheMachineComeOnce) {
  const scene::LinkFrames frames(model_);
  MarkerTopic topic(*writer_, model_, frames);
  for (std::int64_t ms = 0; ms < 50; ++ms) topic.write(1'000'000 * ms, Vector3::Zero());
  const auto all = messages("/machine");
  ASSERT_EQ(all.size(), 1U);
  CdrParts parts(all[0].data);
  const auto bodies = scene::bodies_of(model_, frames, model_.tool_length_mm);
  ASSERT_EQ(parts.number<std::uint32_t>(), bodies.size());
  for (const scene::Body& body : bodies) {
    std::int32_t type = 0;
    EXPECT_EQ(read_front(parts, type), body.frame);
    EXPECT_EQ(type, body.shape == scene::Shape::kBox ? 1 : 3);
    EXPECT_EQ(parts.number<std::uint32_t>(), 0U) << "points";
    expect_end(parts);
  }
  EXPECT_TRUE(parts.is_over());
}

TEST_F(SceneTopics, TrailIsTheWayOfTheLastTwentySeconds) {
  MarkerTopic topic(*writer_, model_, scene::LinkFrames(model_));
  std::int64_t ms = 0;
  for (; ms <= 40'500; ++ms) topic.write(1'000'000 * ms, Vector3(static_cast<double>(ms), 0, 0));
  topic.finish(40'500'000'000);
  const auto all = messages("/trail");
  ASSERT_EQ(all.size(), 22U) << "0 s, 2 s to 40 s, and the rest";
  CdrParts parts(all.back().data);
  ASSERT_EQ(parts.number<std::uint32_t>(), 1U);
  std::int32_t type = 0;
  EXPECT_EQ(read_front(parts, type), "workpiece");
  EXPECT_EQ(type, 4);
  ASSERT_EQ(parts.number<std::uint32_t>(), 500U);
  for (int i = 0; i < 500; ++i) {
    EXPECT_NEAR(vector(parts).x(), 1e-3 * (40'480 - 40 * (499 - i)), 5e-7) << i;
  }
  expect_end(parts);
  EXPECT_TRUE(parts.is_over());
}

}  // namespace
}  // namespace meridian::ros
