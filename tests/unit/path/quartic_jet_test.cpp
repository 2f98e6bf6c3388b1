// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>

#include "meridian/path/pose_at.hpp"

/// The quartic of a jet has a short cut for the variable itself: its results are those of the
/// generic path.
namespace meridian::test::quartic_jet {
namespace {

constexpr std::array<std::array<double, 5>, 4> kQuartics{{{100, 1, 0.5, -0.25, 0.125},
                                                          {-0.2, 0.01, 0.02, -0.002, 0.0005},
                                                          {1e-7, -3e5, 0.1, 7, -1.0 / 3},
                                                          {0, 0, 0, 0, 0}}};
constexpr double kPoints[] = {-1.3, 0, 1e-9, 0.7, 1, 12.5};

template <int N>
void expect_as_generic(const Jet<N>& x) {
  for (const auto& c : kQuartics) {
    const Jet<N> quick = quartic_at(c, x), generic = quartic_at<Jet<N>>(c, x);
    for (int n = 0; n <= N; ++n) {
      EXPECT_EQ(quick.c[n], generic.c[n]) << "N " << N << ", order " << n << ", at " << x.c[0];
    }
  }
}

template <class T>
class QuarticJet : public testing::Test {};
using Orders = testing::Types<Jet<1>, Jet<2>, Jet<3>, Jet<4>>;
TYPED_TEST_SUITE(QuarticJet, Orders);

TYPED_TEST(QuarticJet, OfTheVariableIsThatOfTheGenericPathBitForBit) {
  for (const double x : kPoints) expect_as_generic(TypeParam::variable(x));
}

TYPED_TEST(QuarticJet, OfAnyOtherJetIsThatOfTheGenericPathToo) {
  for (const double x : kPoints) {
    expect_as_generic(TypeParam(x));
    expect_as_generic(TypeParam::with_derivative(x, 2.5));
    const TypeParam variable = TypeParam::variable(x);
    expect_as_generic(TypeParam(variable * variable));
    for (std::size_t order = 2; order < variable.c.size(); ++order) {
      TypeParam bent = variable;
      bent.c[order] = 0.3;
      expect_as_generic(bent);
    }
  }
}

TEST(QuarticJetDerivatives, AreThoseOfThePolynomial) {
  const std::array<double, 5> c{3, -1, 0.5, 2, -0.25};
  const double x = 1.5;
  const Jet<4> at = quartic_at(c, Jet<4>::variable(x));
  EXPECT_DOUBLE_EQ(at.derivative(0), 3 + x * (-1 + x * (0.5 + x * (2 - 0.25 * x))));
  EXPECT_DOUBLE_EQ(at.derivative(1), -1 + x * (1 + x * (6 - x)));
  EXPECT_DOUBLE_EQ(at.derivative(2), 1 + x * (12 - 3 * x));
  EXPECT_DOUBLE_EQ(at.derivative(3), 12 - 6 * x);
  EXPECT_DOUBLE_EQ(at.derivative(4), -6);
}

}  // namespace
}  // namespace meridian::test::quartic_jet
