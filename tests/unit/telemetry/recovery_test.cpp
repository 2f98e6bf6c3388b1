// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/journal/recovery.hpp"

#include <gtest/gtest.h>

#include <string>

namespace meridian::telemetry {
namespace {

/// part.apt, cut up to line 201, and a session that goes on with it as it was.
class Recovery : public testing::Test {
 protected:
  Recovery() {
    last.session = 7;
    last.next_line = 201;
    last.file_checksum = 11;
    last.setup = setup;
    put_text("part.apt", last.program);
    put_text("--units mm", last.options);
    request.session = 8;
    request.program = "part.apt";
    request.options = "--units mm";
    request.file_checksum = 11;
    request.from_line = 201;
  }
  [[nodiscard]] std::string refusal() const { return refusal_to_go_on(last, request, setup); }
  [[nodiscard]] std::string remark() const { return remark_on(last, request, setup); }

  CutSetup setup{1, 2, 3, 100};
  JournalEntry last;
  dds::SessionRequest request;
};

TEST_F(Recovery, IsTakenAsItWasBegun) {
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(remark(), "");
  request.program = "copy.apt";
  EXPECT_EQ(refusal(), "") << "the same file";
  EXPECT_EQ(remark(), "");
}

TEST_F(Recovery, WithAnotherFileOtherOptionsOrInAnotherFrameIsRefusedByName) {
  request.file_checksum = 12;
  EXPECT_EQ(refusal(),
            "part.apt is another file than the one that is cut up to line 201; go on with what was "
            "begun, or say --changed if it is meant");
  request.file_checksum = 11;
  request.options = "--units inch";
  EXPECT_EQ(refusal(),
            "part.apt was begun with options '--units mm', not '--units inch'; go on with what was "
            "begun, or say --changed if it is meant");
  request.options = "--units mm";
  setup.frame = 9;
  EXPECT_NE(refusal().find("the workpiece's frame is not the one"), std::string::npos) << refusal();
}

TEST_F(Recovery, ThatIsMeantOrBeginsAnewOrIsOfAnotherProgramIsTaken) {
  request.file_checksum = 12;
  request.policies = dds::kPolicyChanged;
  EXPECT_EQ(refusal(), "");
  request.policies = 0;
  request.from_line = 0;
  EXPECT_EQ(refusal(), "");
  request.from_line = 10;
  request.program = "other.apt";
  EXPECT_EQ(refusal(), "");
  request.program = "part.apt";
  last.reached = Reached::kEnd;
  EXPECT_EQ(refusal(), "") << "nothing is left of the one before";
}

TEST_F(Recovery, SaysWhatItDropsOrPassesOverAndWhatElseIsOther) {
  request.program = "other.apt";
  request.file_checksum = 12;
  EXPECT_EQ(remark(),
            "part.apt is not finished: its start drops that from the journal (it is gone "
            "on with by --from-line 201)");
  request.policies = dds::kPolicyMove;
  EXPECT_EQ(remark(), "") << "a move drops nothing";
  request.policies = 0;
  request.program = "part.apt";
  request.file_checksum = 0;  // a pipe
  request.from_line = 300;
  EXPECT_EQ(remark(), "lines 201 to 299 of part.apt are passed over, they are not cut");
  request.from_line = 201;
  setup.tools = 9;
  EXPECT_EQ(remark(), "the tool table is another one than when part.apt was begun");
}

}  // namespace
}  // namespace meridian::telemetry
