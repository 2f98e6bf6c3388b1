// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/calibrate/touch_off.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "service/machine/inspect/calibrate/least_squares.hpp"
#include "service/text/printed.hpp"

namespace meridian::inspect {

using text::printed;
namespace {

constexpr double kAlongAxis = 0.866;  // cosine of 30 degrees
constexpr double kSpread_mm = 1e-3;   // touches of one face must lie farther apart
constexpr double kFlank = 0.5;        // sine: flatter, a flat tool touches with its tip
constexpr int kNormalSteps = 20;      // contact and normal settle: each step leaves r * tilt^2

using Group = std::vector<const Touch*>;

struct Search {
  const MachineModel& machine;
  Eigen::Matrix3d rotation;  ///< axes of the frame
  Vector3 origin;
  std::string arithmetic;
};

[[nodiscard]] const char* name_of_axis(int axis) { return axis == 0 ? "x" : axis == 1 ? "y" : "z"; }

/// Where the tool of `touch` meets a face with the outward normal `n`.
[[nodiscard]] Vector3 contact_of(const Touch& touch, const Vector3& n, const MachineModel& model) {
  const ToolPose pose = pose_of(touch, model);
  if (touch.is_ball) return pose.tip + touch.radius_mm * (pose.axis - n);
  const Vector3 across = n - n.dot(pose.axis) * pose.axis;
  if (across.norm() < kFlank) return pose.tip;
  return pose.tip - touch.radius_mm * across.normalized();
}

/// Touches by the axis of the frame that they went along; false where one went along none.
[[nodiscard]] bool group(const std::vector<Touch>& touches, const Eigen::Matrix3d& axes,
                         std::array<Group, 3>& groups) {
  for (const Touch& touch : touches) {
    const Vector3 along = (axes.transpose() * touch.toward).cwiseAbs();
    int axis = 0;
    if (along.maxCoeff(&axis) < kAlongAxis) return false;
    groups[static_cast<std::size_t>(axis)].push_back(&touch);
  }
  return true;
}

void report_contact(Search& search, const Touch& touch, const Vector3& contact, int axis) {
  const Vector3 tip = pose_of(touch, search.machine).tip;
  search.arithmetic +=
      printed("tip %.4f %.4f %.4f mm, radius %.4f mm%s: face %s at %.4f %.4f %.4f mm\n", tip.x(),
              tip.y(), tip.z(), touch.radius_mm, touch.is_ball ? " (ball)" : "", name_of_axis(axis),
              contact.x(), contact.y(), contact.z());
}

/// Moves the origin along `axis` of the frame into the face that `touch` met.
void take_face(Search& search, const Touch& touch, int axis) {
  const Vector3 a = search.rotation.col(axis);
  const Vector3 normal = touch.toward.dot(a) > 0 ? Vector3(-a) : a;
  const Vector3 contact = contact_of(touch, normal, search.machine);
  report_contact(search, touch, contact, axis);
  search.origin += (contact - search.origin).dot(a) * a;
}

/// The outward normal of the face that `touches` met: across what `across` makes of their contacts.
/// Zero where they do not determine one.
template <class Across>
[[nodiscard]] Vector3 find_normal(const Search& search, const Group& touches, Across across) {
  const Vector3 outward = -touches.front()->toward;
  Vector3 normal = outward;
  for (int step = 0; step < kNormalSteps; ++step) {
    std::vector<Vector3> contacts;
    for (const Touch* touch : touches) {
      contacts.push_back(contact_of(*touch, normal, search.machine));
    }
    const Vector3 next = across(contacts);
    if (next.norm() == 0) return next;
    normal = next.dot(outward) < 0 ? Vector3(-next) : next;
  }
  return normal;
}

[[nodiscard]] Vector3 unit_or_zero(const Vector3& v, double min) {
  return v.norm() > min ? Vector3(v.normalized()) : Vector3(Vector3::Zero());
}

[[nodiscard]] Vector3 plane_normal(const Search& search, const Group& touches) {
  return find_normal(search, touches, [](const std::vector<Vector3>& c) {
    const Vector3 u = c[1] - c[0], v = c[2] - c[0];
    return unit_or_zero(u.cross(v), kSpread_mm * std::max(u.norm(), v.norm()));
  });
}

/// Of two touches, and at right angles to `z`.
[[nodiscard]] Vector3 side_normal(const Search& search, const Group& touches, const Vector3& z) {
  return find_normal(search, touches, [&z](const std::vector<Vector3>& c) {
    return unit_or_zero((c[1] - c[0]).cross(z), kSpread_mm);
  });
}

/// Turns the axes so that `axis` has the direction of `normal`, the way that it looked before, and
/// the next one stays as near to where it was as it can; or, where `kept` is an axis, that stays.
void turn(Search& search, int axis, const Vector3& normal, int kept = -1) {
  Eigen::Matrix3d& r = search.rotation;
  const Vector3 a = normal.dot(r.col(axis)) > 0 ? normal : Vector3(-normal);
  const int second = kept >= 0 ? kept : (axis + 1) % 3;
  const Vector3 b = (r.col(second) - r.col(second).dot(a) * a).normalized();
  const int third = 3 - axis - second;
  const bool is_cyclic = (axis + 1) % 3 == second;
  const Vector3 c = is_cyclic ? a.cross(b) : b.cross(a);
  r.col(axis) = a;
  r.col(second) = b;
  r.col(third) = c;
}

[[nodiscard]] std::string lacks(const char* what) { return std::string("touch ") + what; }

[[nodiscard]] std::string find_side(Search& search, const std::array<Group, 3>& groups,
                                    std::size_t count, const char* what) {
  for (int axis = 0; axis < 3; ++axis) {
    const Group& touches = groups[static_cast<std::size_t>(axis)];
    if (touches.empty()) continue;
    if (touches.size() != count) return lacks(what);
    const int kept = axis == 2 ? 0 : 2;
    if (count > 1) {
      const Vector3 normal = count == 3 ? plane_normal(search, touches)
                                        : side_normal(search, touches, search.rotation.col(kept));
      if (normal.norm() == 0) return "the touches lie on one line, or too near to each other";
      turn(search, axis, normal, count == 3 ? -1 : kept);
    }
    for (const Touch* touch : touches) take_face(search, *touch, axis);
  }
  return "";
}

/// Three touches of one face, two of the next, one of the last: all of the frame.
[[nodiscard]] std::string find_tilted_corner(Search& search, const std::array<Group, 3>& groups) {
  const auto axis_with = [&groups](std::size_t count) {
    for (int axis = 0; axis < 3; ++axis) {
      if (groups[static_cast<std::size_t>(axis)].size() == count) return axis;
    }
    return -1;
  };
  const int first = axis_with(3), second = axis_with(2), third = axis_with(1);
  if (first < 0 || second < 0 || third < 0) {
    return lacks("three faces once each, or one of them three times, one twice and one once");
  }
  const Vector3 primary = plane_normal(search, groups[static_cast<std::size_t>(first)]);
  if (primary.norm() == 0) return "the three touches lie on one line, or too near to each other";
  turn(search, first, primary);
  const Vector3 side =
      side_normal(search, groups[static_cast<std::size_t>(second)], search.rotation.col(first));
  if (side.norm() == 0) return "the two touches of one face are too near to each other";
  turn(search, second, side, first);
  for (const int axis : {first, second, third}) {
    for (const Touch* touch : groups[static_cast<std::size_t>(axis)]) {
      take_face(search, *touch, axis);
    }
  }
  return "";
}

[[nodiscard]] std::string find_corner(Search& search, const std::array<Group, 3>& groups,
                                      std::size_t count) {
  if (count != 3) return find_tilted_corner(search, groups);
  for (int axis = 0; axis < 3; ++axis) {
    const Group& touches = groups[static_cast<std::size_t>(axis)];
    if (touches.size() != 1) return lacks("three faces once each");
    take_face(search, *touches.front(), axis);
  }
  return "";
}

/// The circle through the tips, across z: least squares of the distances to it.
[[nodiscard]] std::string find_bore(Search& search, const std::vector<Touch>& touches,
                                    double& residual_mm) {
  if (touches.size() < 3) return lacks("the bore three or four times");
  const auto count = static_cast<Eigen::Index>(touches.size());
  Eigen::MatrixX2d points(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vector3 tip = pose_of(touches[static_cast<std::size_t>(i)], search.machine).tip;
    points.row(i) = (search.rotation.transpose() * (tip - search.origin)).head<2>();
    search.arithmetic += printed("tip %.4f %.4f %.4f mm\n", tip.x(), tip.y(), tip.z());
  }
  const Eigen::RowVector2d middle = points.colwise().mean();
  Eigen::MatrixXd lines(count, 3);
  lines << 2 * (points.rowwise() - middle), Eigen::VectorXd::Ones(count);
  const Eigen::VectorXd squares = (points.rowwise() - middle).rowwise().squaredNorm();
  const LeastSquares solved = solve_least_squares(lines, squares);
  if (solved.rank < 3) return "the touches lie on one line";
  const Eigen::Vector3d guess = solved.x;
  Eigen::Vector3d circle(guess[0] + middle[0], guess[1] + middle[1],
                         std::sqrt(std::max(0.0, guess[2] + guess.head<2>().squaredNorm())));
  Eigen::VectorXd off(count);
  for (int step = 0; step < 20; ++step) {
    Eigen::MatrixXd slopes(count, 3);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Vector2d from = points.row(i).transpose() - circle.head<2>();
      off[i] = from.norm() - circle[2];
      slopes.row(i) << -from.normalized().transpose(), -1;
    }
    circle -= solve_least_squares(slopes, off).x;
  }
  residual_mm = off.cwiseAbs().maxCoeff();
  search.origin += search.rotation.leftCols<2>() * circle.head<2>();
  search.arithmetic += printed("bore of %.4f mm, touches off its circle by up to %.4f mm\n",
                               2 * (circle[2] + touches.front().radius_mm), residual_mm);
  return "";
}

}  // namespace

Expected<FoundFrame, std::string> find_frame(TouchedShape shape, const std::vector<Touch>& touches,
                                             const MachineModel& before) {
  Search search{before, before.X_MW.rotation, before.X_MW.origin_mm, ""};
  FoundFrame found;
  std::array<Group, 3> groups;
  std::string error;
  if (shape != TouchedShape::kBore && !group(touches, search.rotation, groups)) {
    return tl::make_unexpected(
        std::string("a touch goes along no axis of the frame; turn the frame nearer first"));
  }
  switch (shape) {
    case TouchedShape::kFace:
      error = touches.size() == 1 ? find_side(search, groups, 1, "") : lacks("one face once");
      break;
    case TouchedShape::kEdge:
      error = touches.size() == 2 ? find_side(search, groups, 2, "one face twice")
                                  : lacks("one face twice");
      break;
    case TouchedShape::kPlane:
      error = touches.size() == 3 ? find_side(search, groups, 3, "one face three times")
                                  : lacks("one face three times");
      break;
    case TouchedShape::kCorner:
      error = find_corner(search, groups, touches.size());
      break;
    case TouchedShape::kBore:
      error = find_bore(search, touches, found.residual_mm);
      break;
  }
  if (!error.empty()) return tl::make_unexpected(error);
  found.rotation = search.rotation;
  found.origin_mm = search.origin;
  found.arithmetic = std::move(search.arithmetic);
  return found;
}

Expected<double, std::string> find_tool_length(const JointVector& joints, double height_mm,
                                               const MachineModel& machine) {
  constexpr double kUpright = 0.5;  // cosine of 60 degrees
  const Pose<double> gauge = forward(machine, 0, joints);
  if (std::abs(gauge.axis[2]) < kUpright) {
    return tl::make_unexpected(std::string("the tool lies across the frame's z; turn it upright"));
  }
  const double length_mm = (gauge.tip[2] - height_mm) / gauge.axis[2];
  if (length_mm >= 0) return length_mm;
  return tl::make_unexpected(
      std::string("the spindle stands below that height: no tool can be so long"));
}

Array3 angles_deg(const Eigen::Matrix3d& r) {
  constexpr double kLocked = 1 - 1e-12;
  const double sine = std::clamp(-r(2, 0), -1.0, 1.0);
  double a = std::atan2(r(2, 1), r(2, 2)), c = std::atan2(r(1, 0), r(0, 0));
  if (std::abs(sine) > kLocked) {  // only their difference or sum is determined
    a = 0;
    c = std::atan2(-r(0, 1), r(1, 1));
  }
  const double b = std::atan2(sine, std::hypot(r(2, 1), r(2, 2)));
  return {units::deg_from_rad(a), units::deg_from_rad(b), units::deg_from_rad(c)};
}

}  // namespace meridian::inspect
