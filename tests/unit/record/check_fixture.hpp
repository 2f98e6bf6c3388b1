// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "meridian/units.hpp"
#include "scratch.hpp"
#include "service/recording/record/check/check.hpp"
#include "support/machines.hpp"
#include "support/sample_recording.hpp"

/// What tests of check() check: recordings made without planner and cycle.
namespace meridian::test {

/// A path with a corner, a spike of 0.02 mm that runs back on itself, tilts and one feed.
[[nodiscard]] inline std::vector<ClBlock> sample_blocks() {
  return {cut_to(1, {80, -40, 20}, 0.3, 30),    cut_to(2, {82, -40, 20}, 0.3, 30),
          cut_to(3, {82.02, -40, 20}, 0.3, 30), cut_to(4, {82, -40, 20}, 0.3, 30),
          cut_to(5, {82, -37, 19}, 0.35, 30),   cut_to(6, {82, -37, 19}, 0.25, 30),
          cut_to(7, {79, -36, 20}, 0.25, 30)};
}

[[nodiscard]] inline record::CheckedPath path_of(const std::vector<ClBlock>& blocks,
                                                 const MachineModel& model) {
  record::CheckedPath path(model.tool_length_mm, model.max_feed_mm_per_s);
  for (const ClBlock& block : blocks) path.add(block, model.tool_length_mm);
  return path;
}

/// A recording of the sample blocks, to spoil and check.
class Check : public ::testing::Test {
 protected:
  Check() : blocks(sample_blocks()), records(SampleRun(model, blocks).records) {
    options.tip_tolerance_mm = 1e-3;
    options.axis_tolerance_rad = units::rad_from_deg(1e-3);
  }

  [[nodiscard]] record::CheckReport run() {
    const Scratch file(".csv");
    record::RecordingReader reader = write_and_open(file.path(), model, records);
    auto report = record::check(reader, path_of(blocks, model), model, options);
    EXPECT_TRUE(report.has_value());
    return *report;
  }

  [[nodiscard]] static bool has(const record::CheckReport& report, record::Finding::Kind kind) {
    return std::any_of(report.findings.begin(), report.findings.end(),
                       [kind](const record::Finding& finding) { return finding.kind == kind; });
  }

  void expect_only(const record::CheckReport& report, record::Finding::Kind kind) {
    EXPECT_TRUE(has(report, kind)) << record::to_text(report);
    EXPECT_EQ(report.findings.size(), 1U) << record::to_text(report);
  }

  /// For runs that are as fast as they like.
  void lift_joint_limits() {
    for (JointSpec& joint : model.joints) {
      joint.limits.velocity = joint.limits.acceleration = joint.limits.jerk = 1e9;
    }
  }

  /// First row of the cut of `line` in which it has begun to move well.
  [[nodiscard]] std::size_t middle_of(std::uint32_t line) const {
    std::size_t first = 0, count = 0;
    for (std::size_t i = 0; i < records.size(); ++i) {
      if (records[i].setpoint.line != line) continue;
      if (count++ == 0) first = i;
    }
    return first + count / 2;
  }

  MachineModel model = lai_machine();
  std::vector<ClBlock> blocks;
  std::vector<CycleRecord> records;
  record::CheckOptions options;
};

}  // namespace meridian::test
