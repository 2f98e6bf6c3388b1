// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/frame_sum.hpp"

#include <gtest/gtest.h>

#include "service/machine/file/machine_file.hpp"

namespace meridian::stream {
namespace {

MachineModel placed(const char* frame) {
  MachineModel model;
  config::place_workpiece(model, config::parse_frame(frame));
  return model;
}

TEST(FrameSum, DistinguishesFramesByEveryOneOfTheirNumbers) {
  const std::uint64_t sum = frame_sum(placed("1,2,3,4,5,6"), {});
  EXPECT_NE(sum, 0U);
  EXPECT_EQ(frame_sum(placed("1,2,3,4,5,6"), {}), sum);
  for (const char* other : {"1.0000000000000002,2,3,4,5,6", "1,2.1,3,4,5,6", "1,2,3.1,4,5,6",
                            "1,2,3,4.1,5,6", "1,2,3,4,5.1,6", "1,2,3,4,5,6.1"}) {
    EXPECT_NE(frame_sum(placed(other), {}), sum) << other;
  }
}

TEST(FrameSum, DistinguishesTablesThatProgramsMayCallFor) {
  const MachineModel model = placed("1,2,3,4,5,6");
  WorkFrame row{.number = 2, .origin_mm = {7, 8, 9}, .rotation_deg = {1, 2, 3}};
  const auto sum_of = [&model](const WorkFrame& one) { return frame_sum(model, {&one, 1}); };
  const std::uint64_t sum = sum_of(row);
  EXPECT_NE(sum, frame_sum(model, {}));
  row.name[0] = 'v';
  EXPECT_EQ(sum_of(row), sum) << "a name moves nothing";
  for (const WorkFrame& other : {WorkFrame{.number = 3, .origin_mm = {7, 8, 9}},
                                 WorkFrame{.number = 2, .origin_mm = {7, 8, 9.1}},
                                 WorkFrame{.number = 2, .origin_mm = {7, 8, 9}}}) {
    EXPECT_NE(sum_of(other), sum);
  }
}

TEST(FrameSum, IsThatOfTheFrameThatCameOverTheWire) {
  const MachineModel model = placed("10,-20,30,11,22,33");
  MachineModel other;
  place_frame(other, rows_of(model.X_MW.rotation), to_array(model.X_MW.origin_mm));
  EXPECT_EQ(other.X_MW.rotation, model.X_MW.rotation);
  EXPECT_EQ(other.X_MW.origin_mm, model.X_MW.origin_mm);
  EXPECT_EQ(frame_sum(other, {}), frame_sum(model, {}));
}

}  // namespace
}  // namespace meridian::stream
