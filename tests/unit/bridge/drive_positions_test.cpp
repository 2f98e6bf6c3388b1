// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/bridge/drive_positions.hpp"

#include <gtest/gtest.h>

namespace meridian::bridge {
namespace {

constexpr std::int64_t kMs = 1'000'000;

[[nodiscard]] dds::DriveFeedback report_of(std::uint32_t mask, double position) {
  dds::DriveFeedback feedback;
  feedback.joint_mask = mask;
  feedback.position.fill(position);
  feedback.statusword.fill(0x1237);
  return feedback;
}

TEST(DrivePositions, GroupsArePutTogether) {
  DrivePositions drives(3);
  EXPECT_FALSE(drives.all());
  drives.add(report_of(0b001, 1), 0);
  EXPECT_FALSE(drives.all()) << "two joints are silent";
  EXPECT_EQ(drives.statusword(0), 0x1237);
  EXPECT_EQ(drives.statusword(1), 0);
  drives.add(report_of(0b110, 2), 0);
  ASSERT_TRUE(drives.all());
  EXPECT_EQ((*drives.all())[0], 1);
  EXPECT_EQ((*drives.all())[2], 2);
}

TEST(DrivePositions, AReportGetsOld) {
  DrivePositions drives(2);
  drives.add(report_of(0b01, 1), 0);
  drives.add(report_of(0b10, 1), 400 * kMs);
  drives.pass(500 * kMs);
  EXPECT_TRUE(drives.all());
  drives.pass(501 * kMs);
  EXPECT_FALSE(drives.all());
  EXPECT_EQ(drives.statusword(0), 0);
  EXPECT_EQ(drives.statusword(1), 0x1237);
}

TEST(DrivePositions, BitsWithoutAJointCountForNothing) {
  DrivePositions drives(2);
  drives.add(report_of(0xFFFFFFFF, 7), 0);
  ASSERT_TRUE(drives.all());
  EXPECT_EQ((*drives.all())[2], 0);
}

}  // namespace
}  // namespace meridian::bridge
