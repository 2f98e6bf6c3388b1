// SPDX-License-Identifier: Apache-2.0
// S + dN, and the toroidal cutter that stands along the normal.
#include "service/programs/surface/wrist_points.hpp"

#include <gtest/gtest.h>

#include "meridian/units.hpp"
#include "service/programs/surface/patch_file.hpp"
#include "service/programs/surface/surface_report.hpp"

namespace meridian::surface {
namespace {

PatchJob reference_patch() {
  return load_patch(MERIDIAN_SOURCE_DIR "/deploy/parts/reference-patch.toml");
}

TEST(WristPoints, LieAlongTheNormalOfEveryContactInTheOrderOfTheCuts) {
  const PatchJob job = reference_patch();
  const auto path = cover(job.rule, job.cover);
  ASSERT_TRUE(path);
  constexpr double kDistance_mm = 80;
  const auto points = wrist_points(*path, kDistance_mm);
  ASSERT_EQ(points.size(), 441U);
  // A ball of 10 mm along the normal: tip, contact and wrist are on one line.
  const Contact& first = path->lines.front().contacts.front();
  EXPECT_LT((points.front().at - (first.pose.tip + kDistance_mm * first.pose.axis)).norm(), 1e-9);
  EXPECT_LT((points.front().normal - first.pose.axis).norm(), 1e-12);
  const auto contacts = in_order(*path);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Foot foot = nearest_foot(*job.surface, points[i].at, contacts[i]->u, contacts[i]->v);
    EXPECT_NEAR(foot.distance_mm, kDistance_mm, 1e-6) << i;
  }
}

TEST(WristPoints, AreWrittenAsATable) {
  const std::string table = to_table({{Vector3(1, -2, 0.5), Vector3(0, 0, 1)}});
  EXPECT_EQ(table,
            "x_mm,y_mm,z_mm,i,j,k\n1.000000,-2.000000,0.500000,0.000000000,0.000000000,"
            "1.000000000\n");
}

TEST(SurfaceErrata, AToroidalCutterAlongTheNormalGougesWhereverThePatchIsHollow) {
  PatchJob job = reference_patch();
  for (const double corner_mm : {1.0, 2.0, 4.0}) {
    job.rule.cutter.corner_radius_mm = corner_mm;
    job.rule.lead_rad = 0;
    EXPECT_EQ(measure(job, *cover(job.rule, job.cover)).gouges, 425U) << corner_mm;
    job.rule.lead_rad = units::rad_from_deg(2);
    EXPECT_EQ(measure(job, *cover(job.rule, job.cover)).gouges, 0U) << corner_mm;
  }
}

}  // namespace
}  // namespace meridian::surface
