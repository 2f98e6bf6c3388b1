// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/python/machine.hpp"

#include <cmath>
#include <limits>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/inspect/pose_solutions.hpp"

namespace meridian::python {
namespace {

namespace py = pybind11;

constexpr py::ssize_t kPoseNumbers = 6;
constexpr double kTravelMargin = 1e-9;

/// Rows of an array of `columns` numbers, or of one row of them.
py::ssize_t rows_of(const Numbers& numbers, py::ssize_t columns, const char* what) {
  const bool is_one = numbers.ndim() == 1;
  if ((!is_one && numbers.ndim() != 2) || numbers.shape(is_one ? 0 : 1) != columns) {
    throw py::value_error(std::string(what) + ": " + std::to_string(columns) +
                          " numbers or rows of them are wanted");
  }
  return is_one ? 1 : numbers.shape(0);
}

/// An array like `numbers`, of `columns` instead.
py::array_t<double> rows_like(const Numbers& numbers, py::ssize_t columns) {
  if (numbers.ndim() == 1) return py::array_t<double>(columns);
  return py::array_t<double>({numbers.shape(0), columns});
}

ToolPose pose_from(const Numbers& numbers, py::ssize_t row) {
  const double* const at = numbers.data() + row * kPoseNumbers;
  const Vector3 axis(at[3], at[4], at[5]);
  const double length = axis.norm();
  if (!(std::abs(length - 1) < 1e-3)) {
    throw py::value_error("pose " + std::to_string(row) + ": the axis has length " +
                          std::to_string(length) + ", 1 is wanted");
  }
  return {Vector3(at[0], at[1], at[2]), Vector3(axis / length)};
}

/// How long the slowest joint takes at its largest velocity, s.
double time_between(const MachineModel& model, const JointVector& a, const JointVector& b) {
  double slowest = 0;
  for (int i = 0; i < model.joint_count; ++i) {
    slowest = std::max(slowest, std::abs(a[i] - b[i]) / model.joints[i].limits.velocity);
  }
  return slowest;
}

/// The solution inside travel that is soonest reached from `from`.
std::optional<JointVector> soonest(const MachineModel& model, const ToolPose& pose,
                                   const JointVector& from) {
  std::optional<JointVector> best;
  double min_time = std::numeric_limits<double>::infinity();
  for (const inspect::PoseSolution& solution : inspect::solve_all(model, pose)) {
    JointVector q = solution.q;
    wind_into_travel(model, from, q);
    if (first_joint_outside_travel(model, q, kTravelMargin) >= 0) continue;
    const double time = time_between(model, from, q);
    if (time < min_time) {
      min_time = time;
      best = q;
    }
  }
  return best;
}

}  // namespace

Machine::Machine(const std::string& file, const std::string& frame,
                 std::optional<double> tool_length_mm)
    : model_(config::load_machine(file)) {
  if (!frame.empty()) config::place_workpiece(model_, config::parse_frame(frame));
  if (tool_length_mm) model_.tool_length_mm = *tool_length_mm;
}

std::vector<std::string> Machine::joint_names() const {
  std::vector<std::string> names;
  for (int i = 0; i < model_.joint_count; ++i) names.push_back(model_.joints[i].name);
  return names;
}

py::array_t<double> Machine::limits() const {
  py::array_t<double> out({py::ssize_t{model_.joint_count}, py::ssize_t{5}});
  auto at = out.mutable_unchecked<2>();
  for (int i = 0; i < model_.joint_count; ++i) {
    const JointSpec& joint = model_.joints[i];
    const double beyond = std::numeric_limits<double>::infinity();
    at(i, 0) = joint.is_endless ? -beyond : joint.limits.travel_min;
    at(i, 1) = joint.is_endless ? beyond : joint.limits.travel_max;
    at(i, 2) = joint.limits.velocity;
    at(i, 3) = joint.limits.acceleration;
    at(i, 4) = joint.limits.jerk;
  }
  return out;
}

py::array_t<double> Machine::home() const {
  py::array_t<double> out(py::ssize_t{model_.joint_count});
  for (int i = 0; i < model_.joint_count; ++i) out.mutable_at(i) = model_.joints[i].home;
  return out;
}

JointVector Machine::joints_from(const Numbers& numbers, py::ssize_t row) const {
  JointVector q{};
  for (int i = 0; i < model_.joint_count; ++i) {
    q[i] = numbers.data()[row * model_.joint_count + i];
  }
  return q;
}

py::array_t<double> Machine::forward(const Numbers& joints) const {
  const py::ssize_t rows = rows_of(joints, model_.joint_count, "joints");
  py::array_t<double> out = rows_like(joints, kPoseNumbers);
  double* at = out.mutable_data();
  for (py::ssize_t row = 0; row < rows; ++row) {
    const ToolPose pose =
        meridian::forward(model_, model_.tool_length_mm, joints_from(joints, row));
    for (int i = 0; i < 3; ++i) *at++ = pose.tip[i];
    for (int i = 0; i < 3; ++i) *at++ = pose.axis[i];
  }
  return out;
}

py::array_t<double> Machine::inverse(const Numbers& poses,
                                     const std::optional<Numbers>& near) const {
  const py::ssize_t rows = rows_of(poses, kPoseNumbers, "poses");
  JointVector from{};
  for (int i = 0; i < model_.joint_count; ++i) from[i] = model_.joints[i].home;
  if (near) {
    if (near->ndim() != 1) throw py::value_error("near: one row of joints is wanted");
    (void)rows_of(*near, model_.joint_count, "near");
    from = joints_from(*near, 0);
  }
  py::array_t<double> out = rows_like(poses, model_.joint_count);
  double* at = out.mutable_data();
  for (py::ssize_t row = 0; row < rows; ++row) {
    const auto q = soonest(model_, pose_from(poses, row), from);
    if (q) from = *q;
    for (int i = 0; i < model_.joint_count; ++i) {
      *at++ = q ? (*q)[i] : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return out;
}

std::vector<BranchSolution> Machine::solutions(const Numbers& pose) const {
  if (pose.ndim() != 1) throw py::value_error("pose: six numbers are wanted");
  (void)rows_of(pose, kPoseNumbers, "pose");
  std::vector<BranchSolution> out;
  for (const inspect::PoseSolution& from : inspect::solve_all(model_, pose_from(pose, 0))) {
    BranchSolution& to = out.emplace_back();
    to.branch = from.branch;
    to.joints.assign(from.q.begin(), from.q.begin() + model_.joint_count);
    to.measure = from.measure;
    to.is_singular = from.is_at_pole;
    if (from.outside >= 0) to.outside = limited_spec(model_, from.outside).name;
  }
  return out;
}

}  // namespace meridian::python
