// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "read_text.hpp"
#include "service/programs/cl/cl_writer.hpp"

namespace meridian::cl {
namespace {

constexpr double kTip_mm = 0.5e-6 + 1e-12;  // six decimals
constexpr double kAxis = 1e-9;              // nine decimals and the normalisation

std::string written(const std::vector<ClBlock>& blocks) {
  std::ostringstream out;
  ClWriter writer(out, "WRITER TEST");
  writer.note("a note");
  for (const ClBlock& block : blocks) writer.write(block);
  return out.str();
}

TEST(Writer, WritesWhatTheReaderReadsBack) {
  const auto first = read_body(
      "LOADTL/7\nSPINDL/900,CCLW\nCOOLNT/MIST\nRAPID\nGOTO/-123.4567891,2000.25,-.0000001,.1,.2,"
      ".974679434\nDELAY/.25\nGOTO/1,2,3,.1,.2,.974679434\nFEDRAT/33.3,MMPM\nGOTO/10,0,0,0,0,1\n"
      "CIRCLE/0,0,0,0,0,-1,10\nGOTO/0,10,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,5,0,.6,.8\n"
      "FEDRAT/INVERS,30\nGOTO/0,0,0,0,.6,.8\nAUXFUN/8\nSTOP\nOPSTOP\nCOOLNT/OFF\nSPINDL/OFF\n");
  ASSERT_EQ(first.error, "");
  const auto second = read_text(written(first.blocks));
  ASSERT_EQ(second.error, "") << written(first.blocks);
  ASSERT_EQ(second.blocks.size(), first.blocks.size());
  for (std::size_t i = 0; i < first.blocks.size(); ++i) {
    const ClBlock& a = first.blocks[i];
    const ClBlock& b = second.blocks[i];
    EXPECT_EQ(a.kind, b.kind) << i;
    EXPECT_EQ(a.action, b.action) << i;
    EXPECT_EQ(a.feed_meaning, b.feed_meaning) << i;
    EXPECT_NEAR(a.feed, b.feed, 1e-11 * a.feed) << i;
    EXPECT_EQ(a.value, b.value) << i;
    EXPECT_STREQ(a.text, b.text) << i;
    EXPECT_EQ(a.is_arc, b.is_arc) << i;
    EXPECT_NEAR(a.sweep_rad, b.sweep_rad, 1e-6) << i;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(a.tip_mm[k], b.tip_mm[k], kTip_mm) << i;
      EXPECT_NEAR(a.axis[k], b.axis[k], kAxis) << i;
    }
  }
}

TEST(Writer, GivesTheSameBytesForWhatItRead) {
  const auto read =
      read_body("GOTO/1.23456,2,3,0,.6,.8\nGOTO/4,5,6\nCIRCLE/0,5,6,0,0,1\nGOTO/0,9,6\n");
  const std::string once = written(read_text(written(read.blocks)).blocks);
  EXPECT_EQ(written(read_text(once).blocks), once);
}

TEST(Writer, KeepsLinesShort) {
  const auto read = read_body(
      "GOTO/-1234.567891,-1234.567891,-1234.567891,-.577350269,-.577350269,-.577350269\n");
  std::istringstream lines(written(read.blocks));
  std::size_t longest = 0;
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  EXPECT_LE(longest, 72U);
}

}  // namespace
}  // namespace meridian::cl
