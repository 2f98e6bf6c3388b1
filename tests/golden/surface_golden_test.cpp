// SPDX-License-Identifier: Apache-2.0
// Surfaces and cutters against tests/golden/surface_patch.csv (generate_surface.py, 60 digits).
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "golden/golden_table.hpp"
#include "service/programs/surface/shape/contact.hpp"

namespace meridian::surface {
namespace {

const std::string kFile = MERIDIAN_SOURCE_DIR "/tests/golden/surface_patch.csv";

// Relative to the sizes at hand: places up to 1e2 mm, derivatives up to 1e3, of doubles.
constexpr double kPosition_mm = 1e-12, kDerivative = 1e-10, kUnit = 1e-13, kCurvature = 1e-13;

/// The numbers behind `# name: ` of the file, parted by commas or semicolons.
std::vector<double> numbers_of(const std::string& name) {
  std::ifstream in(kFile);
  std::vector<double> out;
  for (std::string line; std::getline(in, line);) {
    const std::string head = "# " + name + ": ";
    if (line.rfind(head, 0) != 0) continue;
    for (char& c : line) c = c == ';' ? ',' : c;
    std::istringstream cut(line.substr(head.size()));
    for (std::string cell; std::getline(cut, cell, ',');) out.push_back(std::stod(cell));
  }
  return out;
}

NurbsSurface golden_surface() {
  NurbsNet net{3, 2, numbers_of("knots_u"), numbers_of("knots_v"), 7, 4, {}, {}};
  const std::vector<double> points = numbers_of("net");
  for (std::size_t i = 0; i + 3 < points.size(); i += 4) {
    net.points.emplace_back(points[i], points[i + 1], points[i + 2]);
    net.weights.push_back(points[i + 3]);
  }
  auto made = NurbsSurface::create(std::move(net));
  if (!made) throw std::runtime_error(made.error().allowed);
  return std::move(*made);
}

Vector3 vector_of(const test::GoldenTable& table, std::size_t row, const std::string& column) {
  return to_vector({table.numbers(row, column, 3)[0], table.numbers(row, column, 3)[1],
                    table.numbers(row, column, 3)[2]});
}

TEST(SurfaceGolden, HasPointsAndBothOrdersOfDerivatives) {
  const NurbsSurface surface = golden_surface();
  const test::GoldenTable table(kFile);
  ASSERT_EQ(table.size(), 40u);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    const SurfacePoint s = surface.evaluate(table.number(row, "u"), table.number(row, "v"));
    EXPECT_LT((s.at - vector_of(table, row, "sx")).norm(), kPosition_mm);
    EXPECT_LT((s.du - vector_of(table, row, "dux")).norm(), kDerivative);
    EXPECT_LT((s.dv - vector_of(table, row, "dvx")).norm(), kDerivative);
    EXPECT_LT((s.duu - vector_of(table, row, "duux")).norm(), 10 * kDerivative);
    EXPECT_LT((s.duv - vector_of(table, row, "duvx")).norm(), 10 * kDerivative);
    EXPECT_LT((s.dvv - vector_of(table, row, "dvvx")).norm(), 10 * kDerivative);
  }
}

TEST(SurfaceGolden, HasNormalsCurvaturesAndTipsOfEveryCutter) {
  const NurbsSurface surface = golden_surface();
  const test::GoldenTable table(kFile);
  for (std::size_t row = 0; row < table.size(); ++row) {
    SCOPED_TRACE(row);
    ContactRule rule;
    rule.surface = &surface;
    rule.cutter = {table.number(row, "diameter"), table.number(row, "corner")};
    rule.lead_rad = table.number(row, "lead");
    rule.tilt_rad = table.number(row, "tilt");
    const auto c = find_contact(rule, table.number(row, "u"), table.number(row, "v"));
    ASSERT_TRUE(c);
    EXPECT_LT((c->shape.normal - vector_of(table, row, "nx")).norm(), kUnit);
    EXPECT_NEAR(c->shape.min_curvature, table.number(row, "k1"), kCurvature);
    EXPECT_NEAR(c->shape.largest_curvature, table.number(row, "k2"), kCurvature);
    EXPECT_LT((c->pose.axis - vector_of(table, row, "i")).norm(), kUnit);
    EXPECT_LT((c->pose.tip - vector_of(table, row, "tipx")).norm(), kPosition_mm);
  }
}

}  // namespace
}  // namespace meridian::surface
