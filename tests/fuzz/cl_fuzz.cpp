// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "fuzz/fuzz_targets.hpp"
#include "fuzz/read_all.hpp"
#include "service/programs/cl/cl_points.hpp"
#include "service/programs/cl/cl_reader.hpp"

namespace meridian::fuzz {
namespace {

constexpr double kUnit = 1e-12;

void check_motion(const ClBlock& block) {
  require(to_vector(block.tip_mm).allFinite(), "a tip that is no number");
  require(std::abs(to_vector(block.axis).norm() - 1) < kUnit, "a tool axis that is no unit vector");
  if (block.kind == BlockKind::kCut) {
    require(std::isfinite(block.feed) && block.feed > 0, "a cut without feed");
  }
  if (!block.is_arc) return;
  require(std::abs(to_vector(block.normal).norm() - 1) < kUnit, "an arc without a normal");
  require(block.sweep_rad > 0 && block.sweep_rad <= 2 * std::numbers::pi, "an arc without a sweep");
}

}  // namespace

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "found: %s\n", what);
  std::abort();
}

void read_all(cl::ClReader& reader) {
  std::uint64_t sequence = 0;
  bool has_ended = false, is_whole = true;
  for (;;) {
    const auto block = reader.next();
    if (!block) {
      require(!block.error().message.empty(), "an error without words");
      require(block.error().line <= reader.summary().lines + 1, "an error behind the file");
      is_whole = false;
      if (!reader.go_on()) return;
      continue;
    }
    if (!*block) break;
    require(!has_ended, "a block after the end");
    require((*block)->sequence == sequence++, "a block is missing");
    has_ended = (*block)->kind == BlockKind::kEnd;
    if (is_motion((*block)->kind)) check_motion(**block);
  }
  require(has_ended || !is_whole, "a program without an end that is no error");
}

void read_cl(Bytes bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  cl::ClReader reader(text, "fuzz");
  read_all(reader);
}

Seeds cl_seeds() {
  constexpr std::string_view kPrograms[] = {
      "PARTNO A\nUNITS/MM\nFROM/0,0,50,0,0,1\nRAPID\nGOTO/10,0,20\nFEDRAT/PERMIN,141\n"
      "GOTO/10.,.0,5.$\n.0,.6,-.8\nCIRCLE/0,0,5,0,0,1,10\nGOTO/0,10,5\nFINI\n",
      "$$ISO\r\nPARTNO B\r\nUNITS/INCH\r\nMULTAX/ON\r\nMSYS/0,0,0,1,0,0,0,1,0\r\nTRNTYP/LOCAL\r\n"
      "CUTTER/10.,5.,$\r\n5.\r\nLOAD/TOOL,4\r\nSPINDL/RPM,7957.75,CLW\r\nCOOLNT/FLOOD\r\n"
      "FEDRAT/0.1,MMPR\r\nGODLTA/0,0,1\r\nEND\r\nFINI\r\n",
      "PARTNO C\nUNITS/MM\nFEDRAT/INVERS,60\nGODLTA/-1\nGOTO/10,0,5\nINDIRV/0,1,0\n"
      "TLON,GOFWD/ (CIRCLE/ 0,0,5,$\n10.0),ON,(LINE/ 0,0,5,-10,0,5)\nDELAY/1.5\nSTOP\nOPSTOP\n"
      "AUXFUN/8\nPPRINT/BEGIN-SECTION,A\nTLAXIS/0,0,1\nGOTO/1 2 3 0 0 1\nSPINDL/OFF\nFINI\n",
      "$$*CATIA0\n$$ 001\n$$ 1 0 0 0\n$$ 0 1 0 0\n$$ 0 0 1 0\nPARTNO D\nUNITS / MM\n"
      "FEDRAT/500,MMPM\nGOTO/1,2,3,0,0,1\nCIRCLE/0,0,5,0,0,1,10.0,.002,.5,10.,0.\nGOTO/10,0,5\n"
      "FINI\n",
      "TOOL PATH/A,TOOL,B\nFEDRAT/MMPM,250\nRAPID\nGOTO/0,0,50,0,0,1\n"
      "CYCLE/DRILL,DEEP,RAPTO,3.,FEDTO,-12.,STEP,5.,RTRCTO,AUTO,MMPM,100.\nGOTO/10,0,0\nCYCLE/OFF\n"
      "GOTO/0,0,0\nNURBS/\nKNOT/0.5,1.0\nCNTRL/1,0,1\nCNTRL/3,0,2\nCNTRL/5,0,1\nCNTRL/10,0,0\n"
      "CIRCLE/0,0,0,0,0,-1,10,.002,.5,10,0,TIMES,3\nGOTO/0,10,4\nGOHOME/0,0,200\nEND-OF-PATH\n",
      "$$-> MFGNO / A\nUNITS / MM\nFEDRAT / 60, MMPM\nGOTO / 0, 0, 20\n"
      "CYCLE / BRKCHP, DEPTH, 20, STEP, 5, MMPM, 100, CLEAR, 3, BACK, 1, TIMES, 2, RETURN, 0\n"
      "GOTO / 1, 0, 0, 0, .6, .8\nCYCLE / OFF\nTRANS / 1, 2, 3\nGOTO / 0, 0, 0\n10, 0, 0\n"
      "CIRCLE / 0, 0, 0, 0, 0, 1, 10\nGOTO / 0, 10, 0\n-10, 0, 0\nROTABL / 90\nFINI\n"};
  Seeds seeds;
  for (const std::string_view program : kPrograms)
    seeds.emplace_back(program.begin(), program.end());
  return seeds;
}

}  // namespace meridian::fuzz
