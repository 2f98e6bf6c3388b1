// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/calibrate/least_squares.hpp"

#include <gtest/gtest.h>

namespace meridian::inspect {
namespace {

TEST(LeastSquares, FindsTheLineThroughPointsBesideIt) {
  Eigen::MatrixXd a(4, 2);
  a << 0, 1, 1, 1, 2, 1, 3, 1;
  Eigen::VectorXd b(4);
  b << 1.1, 2.9, 5.1, 6.9;  // 2 x + 1, off by 0.1 either way
  const LeastSquares solved = solve_least_squares(a, b);
  EXPECT_EQ(solved.rank, 2);
  EXPECT_NEAR(solved.x[0], 1.96, 1e-12);
  EXPECT_NEAR(solved.x[1], 1.06, 1e-12);
}

TEST(LeastSquares, LeavesWhatIsNotDeterminedAtZero) {
  Eigen::MatrixXd a(3, 2);
  a << 1, 1, 2, 2, 3, 3;
  Eigen::VectorXd b(3);
  b << 2, 4, 6;
  const LeastSquares solved = solve_least_squares(a, b);
  EXPECT_EQ(solved.rank, 1);
  EXPECT_NEAR(solved.x[0], 1, 1e-12);
  EXPECT_NEAR(solved.x[1], 1, 1e-12);
  EXPECT_NEAR(std::abs(solved.directions(0, 1)), std::sqrt(0.5), 1e-12) << "x0 - x1 is open";
}

TEST(LeastSquares, CallsOpenWhatIsNotAboveTheBound) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3, 2);
  a(0, 0) = 1;
  a(1, 1) = 1e-4;
  const Eigen::VectorXd b = a * Eigen::Vector2d(1, 1);
  EXPECT_EQ(solve_least_squares(a, b).rank, 2);
  const LeastSquares bounded = solve_least_squares(a, b, 1e-3);
  EXPECT_EQ(bounded.rank, 1);
  EXPECT_NEAR(bounded.x[1], 0, 1e-12);
}

}  // namespace
}  // namespace meridian::inspect
