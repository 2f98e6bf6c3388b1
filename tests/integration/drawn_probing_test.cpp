// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "integration/probed_run.hpp"
#include "meridian/units.hpp"
#include "service/analysis/simulate/move_forecast.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/inspect/calibrate/touch_off.hpp"

/// Touches of a simulated surface: what is reported of a contact holds, at any speed and cycle
/// time.
namespace meridian::test {
namespace {

constexpr double kBall_mm = 3;
/// The tip leaves its line by the second order of the lag on machines whose joints are not
/// straight, and the servos are exact to rounding.
constexpr double kOffLine_mm = 1e-5;

struct Posture {
  const char* machine;
  JointVector joints;
};

/// A machine with a probe of length 0 beyond its tool: the stylus ends where the tool does.
MachineModel machine_of(const Posture& posture, std::int64_t cycle_ns) {
  MachineModel machine = config::load_machine(std::string(MERIDIAN_SOURCE_DIR "/deploy/machines/") +
                                              posture.machine + ".toml");
  machine.cycle_ns = cycle_ns;
  return machine;
}

Vector3 drawn_direction(std::mt19937_64& engine) {
  std::uniform_int_distribution<int> axis(0, 5);
  const int drawn = axis(engine);
  Vector3 direction = Vector3::Zero();
  direction[drawn / 2] = drawn % 2 == 0 ? 1 : -1;
  return direction;
}

/// A sphere that the ball meets when its centre is at `centre`, up to 40 degrees off `direction`.
drives::ProbedShape sphere_at(const Vector3& centre, const Vector3& direction,
                              std::mt19937_64& engine) {
  std::uniform_real_distribution<double> radius(5, 50), off(-0.55, 0.55);
  const Vector3 toward = (direction + Vector3(off(engine), off(engine), off(engine))).normalized();
  drives::ProbedShape sphere;
  sphere.kind = drives::ProbedShape::Kind::kSphere;
  sphere.radius_mm = radius(engine);
  sphere.origin_mm = centre + (kBall_mm + sphere.radius_mm) * toward;
  return sphere;
}

/// A probing move, and what it may come to.
struct Case {
  MachineModel machine;
  JointVector at{};
  stream::StraightMove move;
  Vector3 direction = Vector3::Zero();
  double distance_mm = 0, stop_mm = 0;
};

Case case_of(const Posture& posture, std::int64_t cycle_ns, double feed, std::mt19937_64& engine) {
  Case out{machine_of(posture, cycle_ns), posture.joints, {}, drawn_direction(engine), 0, 0};
  out.distance_mm = std::min(20.0, feed / 60);  // a second of it
  const ToolPose from = forward(out.machine, out.machine.tool_length_mm, out.at);
  out.move = {from, {from.tip + out.distance_mm * out.direction, from.axis}, feed, {}};
  EXPECT_EQ(simulate::forecast(out.move, out.at, out.machine).refusal, "");
  out.stop_mm = simulate::stop_distance_mm(out.move, out.at, out.machine);
  return out;
}

void expect_touch(const Case& probing, double contact_mm, const drives::ServoLag& lag,
                  std::mt19937_64& engine) {
  const Vector3 contact = probing.move.from.tip + contact_mm * probing.direction;
  drives::ProbedPart part;
  part.length_mm = probing.machine.tool_length_mm;
  part.ball_mm = kBall_mm;
  const Vector3 centre = contact + kBall_mm * probing.move.from.axis;
  part.shapes.push_back(sphere_at(centre, probing.direction, engine));
  ProbedRun run(probing.move, probing.machine, probing.at, lag, part);
  const FoundTouch found = run.go();
  ASSERT_TRUE(found.is_found);
  EXPECT_EQ(found.periods, 1U);
  EXPECT_LE((found.tip - contact).norm(), found.uncertainty_mm + kOffLine_mm);
  const double feed = units::per_s_from_per_min(probing.move.feed_mm_per_min);
  const double period_s = 1e-9 * static_cast<double>(probing.machine.cycle_ns);
  EXPECT_LE(found.uncertainty_mm, feed * period_s * 1.001 + kOffLine_mm);
  EXPECT_LE((found.rest_tip - found.tip).norm(), probing.stop_mm + found.lag_mm + kOffLine_mm);
}

TEST(DrawnProbing, AThousandTouchesAreInsideTheirUncertaintyAndStopInsideTheirDistance) {
  constexpr int kTouches = 20;  // of each case
  const Posture postures[] = {{"trunnion-ac", {20, -30, 40, 0, 0, 0}},
                              {"lai", {30, -20, 60, units::rad_from_deg(50), 0.4, 0}}};
  std::mt19937_64 engine(20261128);
  int touches = 0;
  for (const Posture& posture : postures) {
    for (const std::int64_t cycle_ns : {250'000, 1'000'000, 2'000'000}) {
      for (const double feed : {60.0, 300.0, 1000.0, 3000.0}) {
        for (const double lag_ms : {0.0, 2.0}) {
          SCOPED_TRACE(std::string(posture.machine) + ", cycle " + std::to_string(cycle_ns) +
                       " ns, feed " + std::to_string(feed) + ", lag " + std::to_string(lag_ms));
          const Case probing = case_of(posture, cycle_ns, feed, engine);
          std::uniform_real_distribution<double> along(0.02, 0.9);
          for (int n = 0; n < kTouches + 1; ++n) {
            const auto kind =
                n % 2 == 0 ? drives::LagKind::kFirstOrder : drives::LagKind::kSecondOrder;
            expect_touch(probing, along(engine) * probing.distance_mm, {kind, lag_ms * 1e-3},
                         engine);
            ++touches;
          }
          if (HasFatalFailure()) return;
        }
      }
    }
  }
  EXPECT_GE(touches, 1000);
}

/// Where a part lies that has its material at +x, +y and below z of the corner.
struct Corner {
  MachineModel machine;
  drives::ProbedPart part;
  Eigen::Matrix3d rotation;
  Vector3 origin;
};

/// The touch of a face of the corner that looks along `axis` of it, `sign`, at `point` of it.
Expected<inspect::Touch, std::string> touch_of_corner(const Corner& corner, const Vector3& point,
                                                      int axis, double sign,
                                                      const drives::ServoLag& lag) {
  constexpr double kAway_mm = 0.4, kFeed = 30;
  Vector3 direction = Vector3::Zero();
  direction[axis] = -sign;
  const Vector3 normal = sign * corner.rotation.col(axis);
  const Vector3 centre = corner.origin + corner.rotation * point + kBall_mm * normal;
  const Vector3 tip = centre - Vector3(0, 0, kBall_mm) - kAway_mm * direction;
  JointVector at{};
  const Vector3 from = forward(corner.machine, corner.machine.tool_length_mm, at).tip;
  for (int i = 0; i < 3; ++i) at[static_cast<std::size_t>(i)] = tip[i] - from[i];
  const ToolPose pose = forward(corner.machine, corner.machine.tool_length_mm, at);
  const stream::StraightMove move{
      pose, {pose.tip + 2 * kAway_mm * direction, pose.axis}, kFeed, {}};
  ProbedRun run(move, corner.machine, at, lag, corner.part);
  const FoundTouch found = run.go();
  if (!found.is_found) return tl::make_unexpected(std::string("no contact"));
  inspect::Touch touch;
  touch.joints = found.joints;
  touch.tool_length_mm = corner.machine.tool_length_mm;
  touch.radius_mm = kBall_mm;
  touch.is_ball = true;
  touch.toward = direction;
  return touch;
}

TEST(DrawnProbing, OfATiltedCornerFindsItsFrame) {
  constexpr double kFrame_mm = 2e-3, kFrame_rad = 1e-5;
  std::mt19937_64 engine(20261129);
  std::uniform_real_distribution<double> tilt(-3, 3), position(-30, 30);
  for (int n = 0; n < 10; ++n) {
    SCOPED_TRACE(n);
    Corner corner{machine_of({"trunnion-ac", {}}, 1'000'000), {}, {}, {}};
    corner.rotation = config::rotation_from_deg(tilt(engine), tilt(engine), tilt(engine));
    corner.origin = Vector3(position(engine), position(engine), position(engine));
    corner.part.length_mm = corner.machine.tool_length_mm;
    corner.part.ball_mm = kBall_mm;
    drives::ProbedShape box;
    box.origin_mm = corner.origin;
    box.rotation = corner.rotation;
    box.size_mm = Vector3(120, 100, -60);
    corner.part.shapes.push_back(box);
    struct Face {
      Vector3 point;
      int axis;
      double sign;
    };
    const Face faces[] = {{{8, 8, 0}, 2, 1},     {{112, 10, 0}, 2, 1},   {{12, 92, 0}, 2, 1},
                          {{10, 0, -12}, 1, -1}, {{110, 0, -14}, 1, -1}, {{0, 40, -15}, 0, -1}};
    std::vector<inspect::Touch> touches;
    for (const Face& face : faces) {
      const auto touch = touch_of_corner(corner, face.point, face.axis, face.sign,
                                         {drives::LagKind::kSecondOrder, n % 2 == 0 ? 0 : 2e-3});
      ASSERT_TRUE(touch) << touch.error();
      touches.push_back(*touch);
    }
    const auto found = inspect::find_frame(inspect::TouchedShape::kCorner, touches, corner.machine);
    ASSERT_TRUE(found) << found.error();
    EXPECT_LT((found->origin_mm - corner.origin).norm(), kFrame_mm) << found->arithmetic;
    const Eigen::AngleAxisd off(corner.rotation.transpose() * found->rotation);
    EXPECT_LT(std::abs(off.angle()), kFrame_rad);
  }
}

}  // namespace
}  // namespace meridian::test
