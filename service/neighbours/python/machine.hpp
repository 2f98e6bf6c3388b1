// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>

#include <optional>
#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"

/// The machine of the Python module. Units: mm, rad, s. Poses: tip x, y, z and unit axis i, j, k in
/// the work frame, six numbers. Joints in machine order. Errors: ValueError.
namespace meridian::python {

using Numbers = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// One branch that puts the tool at a pose, inside travel or not.
struct BranchSolution {
  int branch = 0;
  std::vector<double> joints;
  double measure = 0;                  ///< distance from singularity (docs/kinematics.md)
  bool is_singular = false;            ///< a rotary joint is free there and stands at home
  std::optional<std::string> outside;  ///< the first joint beyond travel
};

class Machine {
 public:
  Machine(const std::string& file, const std::string& frame, std::optional<double> tool_length_mm);

  [[nodiscard]] const MachineModel& model() const noexcept { return model_; }
  [[nodiscard]] std::vector<std::string> joint_names() const;
  [[nodiscard]] pybind11::array_t<double> limits() const;
  [[nodiscard]] pybind11::array_t<double> home() const;

  /// Poses of joints, eq. of the machine's family; shape (n, joints) to (n, 6), or one row.
  [[nodiscard]] pybind11::array_t<double> forward(const Numbers& joints) const;
  /// Joints of poses, shape (n, 6) to (n, joints), or one row: of the branches inside travel the
  /// one that is soonest reached from the row before, the first from `near` (home). NaN where there
  /// is none.
  [[nodiscard]] pybind11::array_t<double> inverse(const Numbers& poses,
                                                  const std::optional<Numbers>& near) const;
  [[nodiscard]] std::vector<BranchSolution> solutions(const Numbers& pose) const;

 private:
  [[nodiscard]] JointVector joints_from(const Numbers& numbers, pybind11::ssize_t row) const;

  MachineModel model_;
};

}  // namespace meridian::python
