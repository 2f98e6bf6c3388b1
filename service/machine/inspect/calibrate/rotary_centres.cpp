// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/calibrate/rotary_centres.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/inspect/calibrate/least_squares.hpp"
#include "service/text/printed.hpp"

namespace meridian::inspect {

using text::printed;
namespace {

constexpr Eigen::Index kMiddle = 4, kRadius = 7;  // unknowns: two for each axis, three, one
constexpr double kStep_mm = 1e-4;                 // of the differences that make slopes
constexpr double kDone_mm = 1e-10;
constexpr double kOpen = 1e-3;  // singular value, per touch, below which nothing is determined
constexpr double kPart = 0.1;   // share of an unknown in what is open

/// Two directions across `axis`.
[[nodiscard]] std::array<Vector3, 2> across(const Vector3& axis) {
  const Vector3 u = axis.unitOrthogonal();
  return {u, axis.cross(u)};
}

/// The problem: from unknowns to how far each touch is outside of the sphere.
class Sphere {
 public:
  Sphere(const MachineModel& machine, const std::vector<Touch>& touches,
         std::optional<double> radius)
      : machine_(machine), touches_(touches), radius_(radius) {
    for (std::size_t i = 0, at = 0; i < machine.chain.chain.size(); ++i) {
      if (machine.chain.chain[i].is_rotary) rotary_[at++] = i;
    }
  }

  [[nodiscard]] Eigen::Index unknowns() const { return radius_ ? kRadius : kRadius + 1; }
  [[nodiscard]] const ChainJoint& joint(std::size_t k) const {
    return machine_.chain.chain[rotary_[k]];
  }
  [[nodiscard]] Vector3 point(std::size_t k, const Eigen::VectorXd& x) const {
    const auto [u, v] = across(joint(k).direction);
    const auto at = static_cast<Eigen::Index>(2 * k);
    return joint(k).point_mm + x[at] * u + x[at + 1] * v;
  }
  [[nodiscard]] double radius(const Eigen::VectorXd& x) const {
    return radius_ ? *radius_ : x[kRadius];
  }

  /// The middles of the touching balls, in the frame of the kinematics; false where the axes make
  /// no machine any more.
  [[nodiscard]] bool find_balls(const Eigen::VectorXd& x, Eigen::MatrixX3d& balls) const {
    auto chain = machine_.chain.chain;
    for (std::size_t k = 0; k < 2; ++k) chain[rotary_[k]].point_mm = point(k, x);
    const auto described = describe_chain(chain, machine_.chain.home_axis, machine_.chain.gauge_mm);
    if (!described) return false;
    MachineModel machine = machine_;
    machine.chain = *described;
    balls.resize(static_cast<Eigen::Index>(touches_.size()), 3);
    for (std::size_t i = 0; i < touches_.size(); ++i) {
      const ToolPose pose = pose_of(touches_[i], machine);
      balls.row(static_cast<Eigen::Index>(i)) = pose.tip + touches_[i].radius_mm * pose.axis;
    }
    return true;
  }
  [[nodiscard]] bool evaluate(const Eigen::VectorXd& x, Eigen::VectorXd& off) const {
    Eigen::MatrixX3d balls;
    if (!find_balls(x, balls)) return false;
    off.resize(balls.rows());
    const Vector3 middle = x.segment<3>(kMiddle);
    for (Eigen::Index i = 0; i < off.size(); ++i) {
      off[i] = (balls.row(i).transpose() - middle).norm() - radius(x) -
               touches_[static_cast<std::size_t>(i)].radius_mm;
    }
    return true;
  }
  [[nodiscard]] bool find_slopes(const Eigen::VectorXd& x, Eigen::MatrixXd& slopes) const {
    slopes.resize(static_cast<Eigen::Index>(touches_.size()), unknowns());
    Eigen::VectorXd above, below;
    for (Eigen::Index k = 0; k < unknowns(); ++k) {
      Eigen::VectorXd moved = x;
      moved[k] = x[k] + kStep_mm;
      if (!evaluate(moved, above)) return false;
      moved[k] = x[k] - kStep_mm;
      if (!evaluate(moved, below)) return false;
      slopes.col(k) = (above - below) / (2 * kStep_mm);
    }
    return true;
  }

 private:
  const MachineModel& machine_;
  const std::vector<Touch>& touches_;
  std::optional<double> radius_;
  std::array<std::size_t, 2> rotary_{};
};

/// Middle and radius of the sphere by the machine file as it is: |c|^2 is linear in them.
[[nodiscard]] bool guess(const Sphere& sphere, const std::vector<Touch>& touches,
                         Eigen::VectorXd& x) {
  Eigen::MatrixX3d balls;
  if (!sphere.find_balls(x, balls)) return false;
  const Eigen::RowVector3d mean = balls.colwise().mean();
  Eigen::MatrixXd lines(balls.rows(), 4);
  lines << 2 * (balls.rowwise() - mean), Eigen::VectorXd::Ones(balls.rows());
  const LeastSquares solved =
      solve_least_squares(lines, (balls.rowwise() - mean).rowwise().squaredNorm());
  if (solved.rank < 4) return false;
  const Eigen::Vector4d found = solved.x;
  x.segment<3>(kMiddle) = mean.transpose() + found.head<3>();
  const double whole = std::sqrt(std::max(0.0, found[3] + found.head<3>().squaredNorm()));
  if (x.size() > kRadius) x[kRadius] = whole - touches.front().radius_mm;
  return true;
}

[[nodiscard]] std::string digits_of(double value) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

}  // namespace

Expected<RotaryCentres, std::string> find_rotary_centres(const MachineModel& machine,
                                                         const std::vector<Touch>& touches,
                                                         std::optional<double> sphere_radius_mm) {
  const auto refuse = [](const std::string& why) { return tl::make_unexpected(why); };
  if (machine.family != MachineFamily::kChain) {
    return refuse("only the axes of machines with family = \"chain\" have points of their own");
  }
  const bool is_by_ball =
      std::all_of(touches.begin(), touches.end(), [](const Touch& touch) { return touch.is_ball; });
  if (!is_by_ball) return refuse("a touch is not by a ball");
  const Sphere sphere(machine, touches, sphere_radius_mm);
  const Eigen::Index unknowns = sphere.unknowns();
  const auto count = static_cast<Eigen::Index>(touches.size());
  if (count <= unknowns) {
    return refuse(printed("%zu touches for %d unknowns: more are needed", touches.size(),
                          static_cast<int>(unknowns)));
  }
  Eigen::VectorXd x = Eigen::VectorXd::Zero(unknowns);
  if (!guess(sphere, touches, x)) return refuse("the touches lie on no sphere");
  Eigen::VectorXd off;
  Eigen::MatrixXd slopes;
  LeastSquares solved;
  for (int step = 0; step < 50; ++step) {
    if (!sphere.evaluate(x, off) || !sphere.find_slopes(x, slopes)) {
      return refuse("the touches lead to axes that make no machine");
    }
    solved = solve_least_squares(slopes, off, kOpen * std::sqrt(static_cast<double>(count)));
    x -= solved.x;
    if (solved.x.norm() < kDone_mm) break;
  }
  if (!sphere.evaluate(x, off)) return refuse("the touches lead to axes that make no machine");

  RotaryCentres found;
  found.sphere_mm = x.segment<3>(kMiddle);
  found.sphere_radius_mm = sphere.radius(x);
  found.rms_mm = std::sqrt(off.squaredNorm() / static_cast<double>(count));
  Eigen::Index farthest = 0;
  found.largest_mm = off.cwiseAbs().maxCoeff(&farthest);
  found.farthest = static_cast<std::size_t>(farthest);
  const double variance = off.squaredNorm() / static_cast<double>(count - unknowns);
  const Eigen::MatrixXd& v = solved.directions;
  for (std::size_t k = 0; k < 2; ++k) {
    RotaryCentre& centre = found.centres[k];
    centre.joint = machine.joints[static_cast<std::size_t>(sphere.joint(k).joint)].name;
    centre.before_mm = sphere.joint(k).point_mm;
    centre.after_mm = sphere.point(k, x);
    for (Eigen::Index row :
         {static_cast<Eigen::Index>(2 * k), static_cast<Eigen::Index>(2 * k + 1)}) {
      double sum = 0;
      for (Eigen::Index i = 0; i < unknowns; ++i) {
        if (i < solved.rank) {
          sum += variance * std::pow(v(row, i) / solved.singular_values[i], 2);
        } else if (std::abs(v(row, i)) > kPart) {
          centre.is_determined = false;
        }
      }
      centre.deviation_mm = std::max(centre.deviation_mm, std::sqrt(sum));
    }
    if (!centre.is_determined) centre.after_mm = centre.before_mm;
  }
  return found;
}

std::string to_text(const RotaryCentres& found) {
  std::string text;
  for (const RotaryCentre& centre : found.centres) {
    const Vector3 &a = centre.before_mm, &b = centre.after_mm;
    text += printed("%-8s point %.4f %.4f %.4f mm", centre.joint.c_str(), a.x(), a.y(), a.z());
    text += centre.is_determined
                ? printed(" -> %.4f %.4f %.4f mm, moved %.4f mm, standard deviation %.4f mm\n",
                          b.x(), b.y(), b.z(), (b - a).norm(), centre.deviation_mm)
                : std::string(
                      " stays: WARNING: the touches do not determine it; touch at more "
                      "angles of this joint and of the other one\n");
  }
  const Vector3& s = found.sphere_mm;
  text += printed("sphere   at %.4f %.4f %.4f mm, radius %.4f mm\n", s.x(), s.y(), s.z(),
                  found.sphere_radius_mm);
  text += printed("touches  off it by %.4f mm rms, %.4f mm at most (touch %zu)\n", found.rms_mm,
                  found.largest_mm, found.farthest + 1);
  return text;
}

Expected<std::string, std::string> with_centres(const std::string& machine_file,
                                                const RotaryCentres& found) {
  std::string text = machine_file;
  for (const RotaryCentre& centre : found.centres) {
    const auto missing = [&centre] {
      return tl::make_unexpected("[joints." + centre.joint +
                                 "] has no line of its own with point_mm = [x, y, z]");
    };
    const std::size_t section = text.find("[joints." + centre.joint + "]");
    if (section == std::string::npos) return missing();
    const std::size_t end = std::min(text.find("\n[", section), text.size());
    const std::size_t key = text.find("\npoint_mm", section);
    if (key >= end) return missing();
    const std::size_t open = text.find('[', key), close = text.find(']', key);
    if (open >= end || close >= end || open > close) return missing();
    const Vector3& p = centre.after_mm;
    text.replace(open, close - open + 1,
                 "[" + digits_of(p.x()) + ", " + digits_of(p.y()) + ", " + digits_of(p.z()) + "]");
  }
  return text;
}

}  // namespace meridian::inspect
