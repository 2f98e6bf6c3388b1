// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/recorded/recorded_limits.hpp"

#include <gtest/gtest.h>

#include "service/recording/record/file/recorded/operator_events_writer.hpp"
#include "support/text_file.hpp"

namespace meridian::record {
namespace {

SoftLimits limits_of(std::size_t joint, double min, double max) {
  SoftLimits limits;
  EXPECT_TRUE(limits.put(joint, min, max));
  return limits;
}

TEST(RecordedLimits, ComeBackBitForBit) {
  const test::TextFile file("");
  auto writer = OperatorEventsWriter::create(file.path());
  ASSERT_TRUE(writer);
  EXPECT_TRUE(writer->write(RecordedLimits{17, 1, -100.0 / 3.0, 1.0 / 7.0}));
  EXPECT_TRUE(writer->write(RecordedLimits{17, 5, 1e-3, 2}));
  EXPECT_TRUE(writer->write(RecordedLimits{17, 1, 1, 1.0 / 3.0 + 1, 1}));
  EXPECT_TRUE(writer->write(RecordedLimits{17, 3, -5, 5, 1}));
  EXPECT_TRUE(writer->write(RecordedLimits{17, 3, -7, -6, 2}));
  EXPECT_TRUE(writer->close());
  SoftLimits wanted = limits_of(0, -100.0 / 3.0, 1.0 / 7.0);
  wanted.put(4, 1e-3, 2);
  KeepOutBox box;
  box.name = {"1"};
  box.joints = 0b101;
  box.min = {1, 0, -5};
  box.max = {1.0 / 3.0 + 1, 0, 5};
  wanted.put(box);
  box.name = {"2"};
  box.joints = 0b100;
  box.min = {0, 0, -7};
  box.max = {0, 0, -6};
  wanted.put(box);
  EXPECT_EQ(find_recorded_limits(test::read_text(file.path())), wanted);
}

TEST(RecordedLimits, AreThoseInForceAtTheFirstStart) {
  const std::string events =
      "cycle,verb,argument,block,span\n0,limits,1,-10,10\n0,limits,2,-5,5\n100,limits,1,-9,9\n"
      "200,start,0\n300,limits,1,-8,8\n400,start,0\n";
  EXPECT_EQ(find_recorded_limits(events), limits_of(0, -9, 9));
  EXPECT_EQ(find_recorded_limits("0,limits,1,-10,10\n9,limits,0,0,0\n20,start,0\n"), SoftLimits());
  EXPECT_FALSE(find_recorded_limits("20,start,0\n"));
  SoftLimits tipped = limits_of(0, -9, 9);
  tipped.put(TipBox{true, {-1, -2, -3}, {1, 2, 3}});
  EXPECT_EQ(find_recorded_limits("0,limits,1,-9,9\n0,tip_box,1,-1,1\n0,tip_box,2,-2,2\n"
                                 "0,tip_box,3,-3,3\n20,start,0\n"),
            tipped);
}

TEST(RecordedLimits, AreFoundWithTheCyclesFromWhichTheyHold) {
  const auto all = find_all_limits("0,limits,1,-10,10\n0,limits,2,-5,5\n9,limits,0,0,0\n");
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].limits.rows()[1], (SoftLimits::Row{true, -5, 5}));
  EXPECT_EQ(all[1].cycle, 9U);
  EXPECT_TRUE(all[1].limits.empty());
}

TEST(RecordedLimits, AreNoneWhereARowHoldsAnythingElse) {
  EXPECT_TRUE(read_limits("0,limits,1,-10,10"));
  for (const char* row :
       {"0,limits,1,-10", "0,limits,1,-10,10,6", "0,limits,x,-10,10", "0,limits,7,-10,10",
        "0,limits,1,nan,10", "0,keep_out,1,-10,10", "0,keep_out,0,1,-10,10",
        "0,keep_out,9,1,-10,10", "0,keep_out,1,0,-10,10", "0,keep_out,1,7,-10,10",
        "0,tip_box,0,-10,10", "0,tip_box,4,-10,10", "0,limit,1,-10,10", "x,limits,1,-10,10"}) {
    EXPECT_FALSE(read_limits(row)) << row;
  }
  EXPECT_TRUE(is_limits_row("0,limits,1,nan,5"));
  EXPECT_FALSE(is_limits_row("0,start,0"));
}

}  // namespace
}  // namespace meridian::record
