// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/recorded/recorded_tools.hpp"

#include <gtest/gtest.h>

#include "service/recording/record/file/recorded/operator_events_writer.hpp"
#include "support/text_file.hpp"

namespace meridian::record {
namespace {

TEST(RecordedTools, ComeBackBitForBit) {
  const test::TextFile file("");
  auto writer = OperatorEventsWriter::create(file.path());
  ASSERT_TRUE(writer);
  EXPECT_TRUE(writer->write(RecordedTool{17, 3, 100.0 / 3.0, 1.0 / 7.0}));
  EXPECT_TRUE(writer->write(RecordedTool{17, 54, 1e-3, 0}));
  EXPECT_TRUE(writer->close());
  EXPECT_EQ(find_recorded_tools(test::read_text(file.path())),
            ToolTable({{3, 100.0 / 3.0, 1.0 / 7.0}, {54, 1e-3, 0}}));
}

TEST(RecordedTools, AreThoseInForceAtTheFirstStart) {
  const std::string events =
      "cycle,verb,argument,block,span\n0,tool,1,110,5\n0,tool,2,95,3\n100,tool,1,111,5\n"
      "200,start,0\n300,tool,1,112,5\n400,start,0\n";
  EXPECT_EQ(find_recorded_tools(events), ToolTable({{1, 111, 5}}));
  EXPECT_EQ(find_recorded_tools("0,tool,1,110,5\n9,tool,0,0,0\n20,start,0\n"), ToolTable());
  EXPECT_EQ(find_recorded_tools("0,tool,1,110,5\n9,tool,1,111,5\n"), ToolTable({{1, 111, 5}}));
  EXPECT_FALSE(find_recorded_tools("20,start,0\n"));
}

TEST(RecordedTools, AreNoneWhereARowHoldsAnythingElse) {
  EXPECT_TRUE(read_tool("0,tool,1,110,5"));
  for (const char* row : {"0,tool,1,110", "0,tool,1,110,5,6", "0,tool,x,110,5", "0,tool,1,nan,5",
                          "0,tools,1,110,5", "x,tool,1,110,5"}) {
    EXPECT_FALSE(read_tool(row)) << row;
  }
  EXPECT_TRUE(is_tool_row("0,tool,1,nan,5"));
  EXPECT_FALSE(is_tool_row("0,start,0"));
}

TEST(RecordedTools, HoldHowLongTheToolWasThatTheFirstProgramBeganWith) {
  EXPECT_EQ(find_recorded_tool_length("10,plan_begun,1,110.5\n30,plan_begun,1,95\n40,start,0\n"
                                      "60,plan_begun,1,100\n"),
            95);
  EXPECT_FALSE(find_recorded_tool_length("10,plan_begun,1\n40,start,0\n"));
}

}  // namespace
}  // namespace meridian::record
