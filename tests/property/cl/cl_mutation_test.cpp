// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include "service/programs/cl/cl_points.hpp"
#include "service/programs/cl/cl_reader.hpp"

namespace meridian::cl {
namespace {

constexpr double kUnit = 1e-12;

/// One of everything, so that mutations reach every word.
constexpr std::string_view kProgram =
    "$$ISO\r\nPARTNO MUTANT\nUNITS / MM\n$$-> CSYS / 1.0, 0.0, 0.0, 0.0,  $\n 0.0, 1.0, 0.0, 0.0, "
    "$\n"
    " 0.0, 0.0, 1.0, 0.0\n$$*CATIA0\n$$ 001\n$$ 1 0 0 0\n$$ 0 1 0 0\n$$ 0 0 1 0\n"
    "MSYS/0,0,0,1,0,0,0,1,0\nTRNTYP/LOCAL\nMULTAX/ON\nCUTTER/10.,5.,$\n5.\nSELECT/TOOL,4\n"
    "LOAD/TOOL,4\nLOADTL/5\nSPINDL / RPM, 7957.75,  CLW\nCOOLNT/FLOOD\nFROM/0,0,50,0,0,1\nRAPID\n"
    "GOTO/10,0,20\nFEDRAT/PERMIN,141\nGOTO / 10.0 , .0 , 5.0 $\n.0 , .6 , -.8\n"
    "CIRCLE/0,0,5,0,0,1,10\nGOTO/0,10,5\nCIRCLE/0,0,5,0,0,1,10.0,.002,.5,10.,0.\nGOTO/10,0,5\n"
    "FEDRAT/0.1,MMPR\nGODLTA/0,0,1\nFEDRAT/INVERS,60\nGODLTA/-1\nGOTO/10,0,5\nINDIRV/0,1,0\n"
    "TLON,GOFWD/ (CIRCLE/ 0,0,5,$\n10.0),ON,(LINE/ 0,0,5,-10,0,5)\nDELAY/1.5\nDELAY/10,REV\nSTOP\n"
    "OPSTOP\nAUXFUN/8\nPPRINT/BEGIN-SECTION,A\nPPRINT/END-SECTION,A\nTOOL PATH/A,TOOL,B\n"
    "PAINT/COLOR,1\nEND-OF-PATH\n"
    "GOTO/0,0,50,0,0,1\nCYCLE/DRILL,DEEP,RAPTO,3.,FEDTO,-12.,STEP,5.,MMPM,100.\nGOTO/10,0,0\n"
    "CYCLE/BRKCHP,DEPTH,20,STEP,5,3,MMPM,100,CLEAR,3,BACK,1,TIMES,2,RETURN,0\nGOTO/9,0,0,0,.6,.8\n"
    "CYCLE/CSINK,CSINK,8,90,RAPTO,2,DWELL,.5\nGOTO/12,0,0,0,0,1\nCYCLE/OFF\nGOTO/0,0,0\nNURBS/\n"
    "KNOT/0.5,1.0\nCNTRL/1,0,1\nCNTRL/3,0,2\nCNTRL/5,0,1\nCNTRL/10,0,0\n"
    "MOVARC/0,0,0,0,0,1,10,ANGLE,90\nGOTO/0,10,0\nCIRCLE/0,0,0,0,0,1,10,TIMES,3\nGOTO/10,0,4\n"
    "TRANS/1,2,3\nGOTO/1,1,1\nTRACUT/1,0,0,5,0,1,0,0,0,0,1,0\nGOTO/1,1,1\nTRACUT/NOMORE\n"
    "ORIGIN/1,2,3\nROTABL/90,CLW\nGOTO/1,1,1,0,0,1\nGOHOME/0,0,200\n"
    "CYCLE/OFF\nTLAXIS/0,0,1\nGOTO/1 2 3 0 0 1\nSPINDL/OFF\nEND\nFINI\n";

std::string mutant(std::mt19937_64& random) {
  std::string text(kProgram);
  const auto below = [&random](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  constexpr std::string_view kNasty = "0123456789.-+,/$ \n\r\tEXNAINF()=\x1a\xe9";
  const std::size_t changes = 1 + below(6);
  for (std::size_t i = 0; i < changes && !text.empty(); ++i) {
    const std::size_t at = below(text.size());
    const std::size_t size = std::min<std::size_t>(1 + below(12), text.size() - at);
    switch (below(5)) {
      case 0:
        text[at] = kNasty[below(kNasty.size())];
        break;
      case 1:
        text.erase(at, size);
        break;
      case 2:
        text.insert(at, text.substr(below(text.size()), 1 + below(40)));
        break;
      case 3:
        text.insert(at, 1 + below(40), kNasty[below(kNasty.size())]);
        break;
      default:
        text[at] = static_cast<char>(below(256));
        break;
    }
  }
  return text;
}

/// A number of a dialect that --dialect can say, from 0 on.
std::size_t below_dialects(std::mt19937_64& random) {
  return std::uniform_int_distribution<std::size_t>(0, dialects().size() - 2)(random);
}

/// Whatever stands in a file: every block that comes out can be checked and run, and reading ends.
TEST(Mutation, GivesSoundBlocksOrARefusalWithItsPlace) {
  constexpr std::uint64_t kSeed = 20240611;
  std::printf("seed %lu\n", static_cast<unsigned long>(kSeed));
  std::mt19937_64 random(kSeed);
  int refused = 0;
  constexpr int kMutants = 20000;
  for (int i = 0; i < kMutants; ++i) {
    const std::string text = i == 0 ? std::string(kProgram) : mutant(random);
    ClReaderOptions options;
    options.dialect = static_cast<Dialect>(i == 0 ? 1 : 1 + below_dialects(random));
    ClReader reader(std::string_view(text), "mutant", options);
    PointWalker walker(0.1);
    std::uint64_t sequence = 0;
    bool ended = false, is_whole = true;
    while (true) {
      const auto block = reader.next();
      if (!block) {
        if (std::exchange(is_whole, false)) ++refused;
        ASSERT_GT(i, 0) << block.error().text();
        ASSERT_FALSE(block.error().message.empty());
        ASSERT_LE(block.error().line, reader.summary().lines + 1) << text;
        if (!reader.go_on()) break;
        continue;
      }
      if (!*block) {
        ASSERT_TRUE(ended || !is_whole) << text;
        break;
      }
      const ClBlock& b = **block;
      ASSERT_FALSE(ended) << "a block after the end";
      ASSERT_EQ(b.sequence, sequence++);
      ASSERT_GE(b.line, 1U);
      ended = b.kind == BlockKind::kEnd;
      if (!is_motion(b.kind)) continue;
      ASSERT_TRUE(to_vector(b.tip_mm).allFinite()) << text;
      ASSERT_NEAR(to_vector(b.axis).norm(), 1, kUnit) << text;
      if (b.kind == BlockKind::kCut) {
        ASSERT_TRUE(std::isfinite(b.feed) && b.feed > 0) << text;
      }
      if (b.is_arc) {
        ASSERT_NEAR(to_vector(b.normal).norm(), 1, kUnit);
        ASSERT_GT(b.sweep_rad, 0);
        ASSERT_LE(b.sweep_rad, 2 * std::acos(-1.0));
      }
      walker.walk(b, [&](const ClPoint& p) {
        ASSERT_TRUE(p.tip.allFinite());
        ASSERT_NEAR(p.axis.norm(), 1, kUnit);
      });
    }
  }
  EXPECT_GT(refused, kMutants / 10);
  EXPECT_LT(refused, kMutants);
}

}  // namespace
}  // namespace meridian::cl
