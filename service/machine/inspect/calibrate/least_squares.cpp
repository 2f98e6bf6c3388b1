// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/calibrate/least_squares.hpp"

#include <Eigen/SVD>
#include <algorithm>

namespace meridian::inspect {

LeastSquares solve_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                 std::optional<double> open) {
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  if (open) svd.setThreshold(std::min(1.0, *open / svd.singularValues()[0]));
  return {svd.solve(b), svd.singularValues(), svd.matrixV(), svd.rank()};
}

}  // namespace meridian::inspect
