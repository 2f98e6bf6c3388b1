// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/shape/nurbs_surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>

#include "service/programs/surface/shape/cutter.hpp"
#include "service/programs/surface/shape/spline_basis.hpp"
#include "service/programs/surface/shape/surface_shape.hpp"
#include "support/heap_watch.hpp"
#include "support/surfaces.hpp"

namespace meridian::surface {
namespace {

using test::surface_of;

TEST(NurbsSurface, MeetsTheCornersOfItsNet) {
  std::mt19937_64 draw(1);
  const NurbsNet net = test::wavy(draw);
  const NurbsSurface surface = surface_of(net);
  const auto [u0, u1] = surface.domain_u();
  const auto [v0, v1] = surface.domain_v();
  EXPECT_LT((surface.evaluate(u0, v0).at - net.points.front()).norm(), 1e-12);
  EXPECT_LT((surface.evaluate(u0, v1).at - net.points[net.columns - 1]).norm(), 1e-12);
  EXPECT_LT((surface.evaluate(u1, v1).at - net.points.back()).norm(), 1e-12);
  EXPECT_LT((surface.evaluate(u1 + 9, v1 + 9).at - net.points.back()).norm(), 1e-12);
}

TEST(NurbsSurface, HasBasisFunctionsThatAddUpToOne) {
  const std::vector<double> knots{0, 0, 0, 0, 0.3, 0.3, 0.7, 1, 1, 1, 1};
  for (double t = 0; t <= 1; t += 0.01) {
    const BasisValues basis = basis_values(knots, 3, t);
    double sum[3] = {};
    for (std::size_t i = 0; i <= 3; ++i) {
      EXPECT_GE(basis.order[0][i], 0);
      for (int k = 0; k < 3; ++k) sum[k] += basis.order[static_cast<std::size_t>(k)][i];
    }
    EXPECT_NEAR(sum[0], 1, 1e-15);
    EXPECT_NEAR(sum[1], 0, 1e-13);
    EXPECT_NEAR(sum[2], 0, 1e-12);
  }
}

/// Largest deviation of the derivatives at (u, v) from central differences, relative to `scale`.
double difference_error(const NurbsSurface& s, double u, double v) {
  constexpr double kStep = 1e-5;
  const SurfacePoint at = s.evaluate(u, v);
  const SurfacePoint right = s.evaluate(u + kStep, v), left = s.evaluate(u - kStep, v);
  const SurfacePoint above = s.evaluate(u, v + kStep), below = s.evaluate(u, v - kStep);
  const auto error = [](const Vector3& is, const Vector3& high, const Vector3& low) {
    return (is - (high - low) / (2 * kStep)).norm() / (1 + is.norm());
  };
  return std::max({error(at.du, right.at, left.at), error(at.dv, above.at, below.at),
                   error(at.duu, right.du, left.du), error(at.duv, above.du, below.du),
                   error(at.duv, right.dv, left.dv), error(at.dvv, above.dv, below.dv)});
}

TEST(NurbsSurface, HasTheDerivativesThatDifferencesGive) {
  std::mt19937_64 draw(2);
  for (int n = 0; n < 60; ++n) {
    const NurbsSurface surface = surface_of(test::wavy(draw));
    const auto [u0, u1] = surface.domain_u();
    const auto [v0, v1] = surface.domain_v();
    std::uniform_real_distribution<double> share(0.01, 0.99);
    for (int i = 0; i < 20; ++i) {
      const double u = u0 + share(draw) * (u1 - u0), v = v0 + share(draw) * (v1 - v0);
      bool is_near_knot = false;  // differences across a knot see two polynomials
      for (const double k : surface.breaks_u(surface.domain_u())) {
        is_near_knot = is_near_knot || std::abs(u - k) < 1e-4;
      }
      for (const double k : surface.breaks_v(surface.domain_v())) {
        is_near_knot = is_near_knot || std::abs(v - k) < 1e-4;
      }
      if (!is_near_knot) {
        EXPECT_LT(difference_error(surface, u, v), 1e-6) << n << ' ' << u << ' ' << v;
      }
    }
  }
}

TEST(NurbsSurface, IsEvaluatedAndTouchedWithoutAHeapCall) {
  if (!watch::is_heap_watched()) GTEST_SKIP() << "sanitizers watch the heap themselves";
  std::mt19937_64 draw(11);
  const NurbsSurface surface = test::surface_of(test::wavy(draw));
  const auto [low_u, high_u] = surface.domain_u();
  const auto [low_v, high_v] = surface.domain_v();
  const Cutter cutter{10, 2};
  double sum = 0;
  const watch::HeapWatch heap;
  for (int n = 0; n < 1000; ++n) {
    const double share = n / 999.0;
    const auto shape = shape_at(surface, low_u + share * (high_u - low_u),
                                high_v - share * (high_v - low_v), false);
    if (!shape) continue;
    const Vector3 axis = leant_axis(shape->normal, shape->tangent_u, 0.1, 0.05);
    sum += touching(cutter, shape->at, shape->normal, axis).tip.z() +
           clearance_curvature(cutter, *shape, axis);
  }
  EXPECT_EQ(heap.calls(), watch::HeapCalls{});
  EXPECT_TRUE(std::isfinite(sum) && sum != 0);
}

TEST(NurbsSurface, HasANormalThatIsUnitAndSquareToBothDerivatives) {
  std::mt19937_64 draw(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (int n = 0; n < 100; ++n) {
    const NurbsSurface surface = surface_of(test::wavy(draw));
    const auto [u0, u1] = surface.domain_u();
    const auto [v0, v1] = surface.domain_v();
    const double u = u0 + share(draw) * (u1 - u0), v = v0 + share(draw) * (v1 - v0);
    const SurfacePoint at = surface.evaluate(u, v);
    const auto shape = shape_at(surface, u, v, false);
    ASSERT_TRUE(shape);
    EXPECT_NEAR(shape->normal.norm(), 1, 1e-15);
    EXPECT_NEAR(shape->normal.dot(at.du.normalized()), 0, 1e-14);
    EXPECT_NEAR(shape->normal.dot(at.dv.normalized()), 0, 1e-14);
    EXPECT_GT(shape->normal.dot(at.du.cross(at.dv)), 0);
    EXPECT_LT(shape_at(surface, u, v, true)->normal.dot(at.du.cross(at.dv)), 0);
  }
}

TEST(SurfaceShape, BendsAsPlaneCylinderAndSphereDo) {
  const NurbsSurface plane = surface_of(test::plane(40, 30));
  const NurbsSurface cylinder = surface_of(test::cylinder(25, 30));
  const NurbsSurface sphere = surface_of(test::sphere(50));
  for (const double u : {0.0, 0.13, 0.5, 0.77}) {
    for (const double v : {0.0, 0.4, 1.0}) {
      const auto flat = shape_at(plane, u, v, false);
      EXPECT_EQ(flat->normal, Vector3::UnitZ());
      EXPECT_EQ(flat->largest_curvature, 0);
      const auto hollow = shape_at(cylinder, u, v, false), round = shape_at(cylinder, u, v, true);
      EXPECT_NEAR(std::hypot(hollow->at[0], hollow->at[2]), 25, 1e-13);
      EXPECT_NEAR(hollow->min_curvature, 0, 1e-15);
      EXPECT_NEAR(hollow->largest_curvature, 1.0 / 25, 1e-14);
      EXPECT_NEAR(round->min_curvature, -1.0 / 25, 1e-14);
      EXPECT_NEAR(hollow->curvature_along(Vector3::UnitY()), 0, 1e-15);
      EXPECT_NEAR(round->curvature_along(round->tangent_u), -1.0 / 25, 1e-14);
      const auto ball = shape_at(sphere, u, v, true);
      EXPECT_NEAR(ball->at.norm(), 50, 1e-13);
      EXPECT_LT((ball->normal - ball->at / 50).norm(), 1e-14);
      EXPECT_NEAR(ball->min_curvature, -1.0 / 50, 1e-14);
      EXPECT_NEAR(ball->largest_curvature, -1.0 / 50, 1e-14);
    }
  }
}

TEST(SurfaceShape, HasNoneAtAPoleNorWhereDerivativesRunTheSameWay) {
  const NurbsSurface sphere = surface_of(test::sphere(50));
  EXPECT_FALSE(shape_at(sphere, 1, 0.3, false));
  const auto near = shape_at(sphere, 1 - 1e-6, 0.3, true);
  ASSERT_TRUE(near);
  EXPECT_LT((near->normal - near->at / 50).norm(), 1e-9);
  NurbsNet folded = test::plane(40, 30);
  folded.points = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {40, 0, 0}};  // all on one line
  EXPECT_FALSE(shape_at(surface_of(folded), 0.5, 0.5, false));
}

TEST(SurfaceShape, FindsTheFootOfAPointNearby) {
  const NurbsSurface sphere = surface_of(test::sphere(50));
  const Vector3 above = 53 * Vector3{1, 2, 1.5}.normalized();
  const Foot foot = nearest_foot(sphere, above, 0.5, 0.5);
  EXPECT_NEAR(foot.distance_mm, 3, 1e-10);
  EXPECT_LT((sphere.evaluate(foot.u, foot.v).at - above * (50.0 / 53)).norm(), 1e-6);
}

struct NetMistake {
  const char* name;
  NurbsFault::Part part;
  std::function<void(NurbsNet&)> make;
};

class WrongNet : public testing::TestWithParam<NetMistake> {};

TEST_P(WrongNet, IsRefusedByThePartThatIsWrong) {
  std::mt19937_64 draw(4);
  NurbsNet net = test::wavy(draw);
  GetParam().make(net);
  const auto made = NurbsSurface::create(net);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().part, GetParam().part);
  EXPECT_FALSE(made.error().allowed.empty());
  EXPECT_FALSE(made.error().remedy.empty());
}

using Part = NurbsFault::Part;
INSTANTIATE_TEST_SUITE_P(
    Every, WrongNet,
    testing::Values(
        NetMistake{"degree", Part::kDegree, [](NurbsNet& n) { n.degree_u = 0; }},
        NetMistake{"high_degree", Part::kDegree, [](NurbsNet& n) { n.degree_v = 10; }},
        NetMistake{"zero_weight", Part::kWeights, [](NurbsNet& n) { n.weights[3] = 0; }},
        NetMistake{"negative_weight", Part::kWeights, [](NurbsNet& n) { n.weights[3] = -1; }},
        NetMistake{"endless_weight", Part::kWeights, [](NurbsNet& n) { n.weights[0] = HUGE_VAL; }},
        NetMistake{"few_weights", Part::kWeights, [](NurbsNet& n) { n.weights.pop_back(); }},
        NetMistake{"few_points", Part::kPoints, [](NurbsNet& n) { n.points.pop_back(); }},
        NetMistake{"no_number", Part::kPoints, [](NurbsNet& n) { n.points[1][2] = NAN; }},
        NetMistake{"few_knots", Part::kKnotsU, [](NurbsNet& n) { n.knots_u.pop_back(); }},
        NetMistake{"falling", Part::kKnotsV, [](NurbsNet& n) { n.knots_v[1] = n.knots_v[0] - 1; }},
        NetMistake{"no_domain", Part::kKnotsU,
                   [](NurbsNet& n) { n.knots_u.assign(n.knots_u.size(), 0.5); }}),
    [](const testing::TestParamInfo<NetMistake>& test) { return std::string(test.param.name); });

TEST(WrongNet, WithAKnotMoreOftenThanTheDegreeIsRefused) {
  NurbsNet net = test::plane(40, 30);
  net.rows = 4;
  net.knots_u = {0, 0, 0.5, 0.5, 1, 1};
  net.points = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0},
                {2, 0, 0}, {2, 1, 0}, {3, 0, 0}, {3, 1, 0}};
  net.weights.assign(8, 1.0);
  const auto made = NurbsSurface::create(net);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().part, Part::kKnotsU);
}

}  // namespace
}  // namespace meridian::surface
