// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "check_fixture.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "service/recording/record/check/check.hpp"

/// Recordings held against the limits that were set live.
namespace meridian::record {
namespace {

using test::Check;

TEST_F(Check, HoldsEveryCycleAgainstTheKeepOutBoxesOfItsTime) {
  KeepOutBox box;  // theta2 beyond 0.34, which the tilts of block 5 reach
  box.joints = 0b10000;
  box.min[4] = 0.34;
  box.max[4] = 0.5;
  const MachineModel own = model;
  ASSERT_TRUE(model.keep_out.add(box));
  const CheckReport report = run();
  expect_only(report, Finding::Kind::kTravel);
  EXPECT_NE(report.findings[0].text.find("keep-out box by up to 0.01"), std::string::npos)
      << report.findings[0].text;
  model = own;
  SoftLimits limits;
  ASSERT_TRUE(limits.put(box));
  options.soft_limits = {{0, limits}};
  expect_only(run(), Finding::Kind::kTravel);
  options.soft_limits = {{0, limits}, {1, SoftLimits()}};
  EXPECT_TRUE(run().passed()) << "it was taken away";
}

TEST_F(Check, HoldsEveryCycleAgainstTheTipBoxesOfItsTime) {
  Array3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for (const CycleRecord& record : records) {
    const Array3 tip = tip_over_base(model, model.tool_length_mm, record.joints);
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], tip[i]);
      high[i] = std::max(high[i], tip[i]);
    }
  }
  SoftLimits limits;
  limits.put(TipBox{true, {low[0] - 1, low[1] - 1, low[2] - 1}, high});
  options.soft_limits = {{0, limits}};
  EXPECT_TRUE(run().passed());
  TipBox narrow = limits.tip_box();
  narrow.max[0] -= 0.5;
  limits.put(narrow);
  options.soft_limits = {{0, limits}};
  const CheckReport report = run();
  expect_only(report, Finding::Kind::kTravel);
  EXPECT_NE(report.findings[0].text.find("tip box by up to 0.5 mm"), std::string::npos)
      << report.findings[0].text;
  options.soft_limits = {{0, limits}, {1, SoftLimits()}};
  EXPECT_TRUE(run().passed()) << "it was cleared";
  model.tip_box = narrow;
  expect_only(run(), Finding::Kind::kTravel);
}

TEST_F(Check, HoldsEveryCycleAgainstTheSoftLimitsOfItsTime) {
  SoftLimits narrow;
  narrow.put(4, -1, 0.34);
  const std::uint64_t end = records.back().setpoint.cycle;
  options.soft_limits = {{0, narrow}};
  expect_only(run(), Finding::Kind::kTravel);
  options.soft_limits = {{end + 1, narrow}};
  EXPECT_TRUE(run().passed()) << "they came later";
  options.soft_limits = {{0, narrow}, {1, SoftLimits()}};
  EXPECT_TRUE(run().passed()) << "they were cleared";
  narrow.put(4, 3, 4);
  options.soft_limits = {{end - 3, narrow}};
  EXPECT_TRUE(run().passed()) << "it rests outside, and goes no farther out";
}

}  // namespace
}  // namespace meridian::record
