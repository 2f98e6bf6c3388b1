// SPDX-License-Identifier: Apache-2.0
#include "meridian/kinematics/chain.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <numbers>
#include <string>

namespace meridian {
namespace {

constexpr double kNominal = 1e-12;

double angle_between(const Vector3& a, const Vector3& b) {
  return atan2(a.cross(b).norm(), a.dot(b));
}

/// A sine or cosine that is nominally zero is zero: poles and reach of orthogonal machines exact.
double snapped(double x) { return std::abs(x) < kNominal ? 0.0 : x; }

bool is_unit(const Vector3& v) { return std::abs(v.norm() - 1.0) < 1e-6; }

/// Sorts the joints into a, b and the three linear ones; returns what is wrong with them, or
/// nothing.
std::string sort_joints(ChainKinematics& k) {
  int rotary = 0, linear = 0;
  for (const ChainJoint& joint : k.chain) {
    if (!is_unit(joint.direction)) return "the direction of a joint is not a unit vector";
    const double sign = joint.is_table_side ? -1.0 : 1.0;
    const Vector3 direction = joint.direction.normalized();
    if (joint.is_rotary && rotary < 2) {
      (rotary++ == 0 ? k.a : k.b) = {joint.joint, sign, direction, joint.point_mm};
    } else if (!joint.is_rotary && linear < 3) {
      k.linear[linear++] = {joint.joint, rotary, sign * direction};
    } else {
      return "it takes two rotary and three linear joints";
    }
  }
  return "";
}

/// A rotary joint that turns the workpiece lies before every joint that moves the tool; one that
/// turns the tool behind every joint that moves the workpiece. Slides beside slides change nothing.
std::string find_misplaced(const std::array<ChainJoint, ChainKinematics::kChainLength>& chain) {
  for (std::size_t head = 0; head < chain.size(); ++head) {
    for (std::size_t table = head + 1; table < chain.size(); ++table) {
      const bool is_wrong = !chain[head].is_table_side && chain[table].is_table_side;
      if (!is_wrong || !(chain[head].is_rotary || chain[table].is_rotary)) continue;
      return "the chain runs from the workpiece to the tool, but joint " +
             std::to_string(head + 1) + ", on the head, stands before joint " +
             std::to_string(table + 1) + ", under the workpiece";
    }
  }
  return "";
}

std::string find_fault(const ChainKinematics& k) {
  constexpr double kMin = 1e-3;
  if (k.a.axis.cross(k.b.axis).norm() < kMin) return "the rotary axes are parallel";
  if (k.b.axis.cross(k.home_axis).norm() < kMin) {
    return "the tool axis is parallel to the rotary axis next to it";
  }
  Eigen::Matrix3d directions;
  for (int i = 0; i < 3; ++i) directions.col(i) = k.linear[i].direction;
  if (std::abs(directions.determinant()) < kMin) {
    return "the linear joints do not span space at home";
  }
  return "";
}

/// Whether the linear joints lie in one plane, or nearly so, at some angles of the rotary ones.
bool do_slides_align(const ChainKinematics& k) {
  constexpr int kSteps = 36;
  constexpr double kNearly = 0.5;  // of what they span at home
  const double home = chain::slide_volume(k, {});
  for (int n = 0; n < kSteps * kSteps; ++n) {
    JointVector q{};
    q[static_cast<std::size_t>(k.a.joint)] = 2 * std::numbers::pi / kSteps * (n / kSteps);
    q[static_cast<std::size_t>(k.b.joint)] = 2 * std::numbers::pi / kSteps * (n % kSteps);
    if (chain::slide_volume(k, q) / home < kNearly) return true;
  }
  return false;
}

/// Frames of both rotary joints, and what stands in them.
void work_out_frames(ChainKinematics& k) {
  const Vector3 y = k.a.axis.cross(k.b.axis).normalized();
  k.frame_a << y.cross(k.a.axis).transpose(), y.transpose(), k.a.axis.transpose();
  k.psi_sin = k.a.axis.cross(k.b.axis).norm();
  k.psi_cos = snapped(k.a.axis.dot(k.b.axis));
  if (k.psi_cos == 0) k.psi_sin = 1.0;
  Eigen::Matrix3d frame_b;
  frame_b << y.cross(k.b.axis).transpose(), y.transpose(), k.b.axis.transpose();
  k.origin_a = k.frame_a * k.a.point_mm;
  k.a_to_b = k.frame_a * (k.b.point_mm - k.a.point_mm);
  k.b_to_gauge = frame_b * (k.gauge_mm - k.b.point_mm);
  k.home_axis_b = frame_b * k.home_axis;
  const bool are_neighbours =
      k.linear[0].group == k.linear[1].group && k.linear[1].group == k.linear[2].group;
  k.group = are_neighbours ? k.linear[0].group : -1;
  k.slides_align = !are_neighbours && do_slides_align(k);
  Eigen::Matrix3d directions;
  for (int i = 0; i < 3; ++i) directions.col(i) = k.linear[i].direction;
  k.slide_inverse = ((k.group == 2 ? frame_b : k.frame_a) * directions).inverse();
}

/// Counts joint a the other way round where the tool axis only just misses its other end: the pole
/// that is missed is along +a.
void face_missed_pole(ChainKinematics& k) {
  const double gap =
      std::numbers::pi - angle_between(k.a.axis, k.b.axis) - angle_between(k.b.axis, k.home_axis);
  const bool is_missed =
      snapped(std::sin(0.5 * gap)) != 0 && std::abs(gap) <= chain::kMaxPoleOffset_rad;
  if (!is_missed || !(k.a.axis.dot(k.home_axis) < 0)) return;
  k.a.axis = -k.a.axis;
  k.a.sign = -k.a.sign;
}

void work_out_constants(ChainKinematics& k) {
  const double psi = angle_between(k.a.axis, k.b.axis);
  const double cone = angle_between(k.b.axis, k.home_axis);
  const double m = 0.5 * (cone - psi), p = 0.5 * (cone + psi);
  k.m_sin = snapped(std::sin(m));
  k.m_cos = k.m_sin == 0 ? 1.0 : std::cos(m);
  k.p_cos = snapped(std::cos(p));
  k.p_sin = k.p_cos == 0 ? 1.0 : std::sin(p);
  const bool is_measured_pole = k.m_sin != 0 && std::abs(2 * m) <= chain::kMaxPoleOffset_rad;
  k.pole_offset_rad = is_measured_pole ? 2 * m : 0;
  k.has_pole = k.m_sin == 0 || is_measured_pole;
  k.outwards = (k.b.axis.dot(k.home_axis) * k.home_axis - k.b.axis).normalized();
  k.has_opposite_pole = k.p_cos == 0;
  k.tilt_sin = k.b.axis.cross(k.home_axis);
  k.tilt_cos = k.home_axis - k.b.axis.dot(k.home_axis) * k.b.axis;
  const double y = k.b.axis.dot(k.a.axis.cross(k.home_axis));
  const double x = k.b.axis.cross(k.a.axis).dot(k.tilt_sin);
  const double norm = std::hypot(x, y);
  work_out_frames(k);
  const double sines = k.psi_sin * k.b.axis.cross(k.home_axis).norm();
  k.b0_sin = snapped(y / norm) / sines;
  k.b0_cos = snapped(x / norm) / sines;
}

}  // namespace

Expected<ChainKinematics, std::string> describe_chain(
    const std::array<ChainJoint, ChainKinematics::kChainLength>& chain, const Vector3& home_axis,
    const Vector3& gauge_mm) {
  ChainKinematics k;
  k.chain = chain;
  if (!is_unit(home_axis)) return tl::unexpected(std::string("the tool axis is not a unit vector"));
  k.home_axis = home_axis.normalized();
  k.gauge_mm = gauge_mm;
  std::string fault = sort_joints(k);
  if (fault.empty()) fault = find_misplaced(chain);
  if (fault.empty()) fault = find_fault(k);
  if (!fault.empty()) return tl::unexpected(fault);
  face_missed_pole(k);
  work_out_constants(k);
  return k;
}

namespace chain {

double pole_distance(const ChainKinematics& k, const Vector3& axis) noexcept {
  const double angle = angle_between(k.a.axis, axis);
  double distance = std::numbers::pi;
  if (k.has_pole) distance = angle;
  if (k.has_opposite_pole) distance = std::min(distance, std::numbers::pi - angle);
  return distance;
}

double slide_volume(const ChainKinematics& k, const JointVector& q) noexcept {
  const SinCos<double> a = sin_cos(k.a.sign * q[k.a.joint]);
  const SinCos<double> b = sin_cos(k.b.sign * q[k.b.joint]);
  Eigen::Matrix3d d;
  for (int i = 0; i < 3; ++i) d.col(i) = column(k, i, a, b);
  return d.determinant();
}

double measure(const ChainKinematics& k, const JointVector& q) noexcept {
  const SinCos<double> a = sin_cos(k.a.sign * q[k.a.joint]);
  const SinCos<double> b = sin_cos(k.b.sign * q[k.b.joint]);
  const Vector3 axis = turn<double>(k.a.axis, a, turn<double>(k.b.axis, b, k.home_axis));
  const Vector3 second = turn<double>(k.a.axis, a, k.b.axis);
  return std::abs(slide_volume(k, q)) * std::abs(k.a.axis.cross(second).dot(axis));
}

Reach reach(const ChainKinematics& k) noexcept {
  const double psi = angle_between(k.a.axis, k.b.axis);
  const double cone = angle_between(k.b.axis, k.home_axis);
  return {k.has_pole ? 0.0 : std::abs(cone - psi),
          std::min(cone + psi, 2.0 * std::numbers::pi - cone - psi)};
}

}  // namespace chain
}  // namespace meridian
