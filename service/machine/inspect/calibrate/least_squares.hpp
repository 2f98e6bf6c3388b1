// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

namespace meridian::inspect {

/// The x for which |A x - b| is least, of the smallest length where several are.
struct LeastSquares {
  Eigen::VectorXd x;
  Eigen::VectorXd singular_values;  ///< of A, falling
  Eigen::MatrixXd directions;       ///< of x, one a column, that belong to them
  Eigen::Index rank = 0;            ///< how many of these directions A determines
};

/// `open`: directions whose singular value is not above it are not determined; nothing: what
/// rounding leaves. One place for it, because its templates are the longest to compile.
/// Source: Golub and Van Loan, Matrix Computations, section 5.5. Proof:
/// tests/unit/inspect/least_squares_test.cpp.
[[nodiscard]] LeastSquares solve_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                               std::optional<double> open = std::nullopt);

}  // namespace meridian::inspect
