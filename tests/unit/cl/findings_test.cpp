// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/findings.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "read_text.hpp"
#include "service/programs/cl/interpreter/run_cl.hpp"

namespace meridian::cl {
namespace {

/// All that reading a text to its end finds.
Findings find_all(const std::string& text) {
  ClReader reader(std::string_view(text), "part.apt");
  Findings findings;
  while (true) {
    const auto block = reader.next();
    if (block && !*block) break;
    if (block) continue;
    findings.add(block.error());
    if (!reader.go_on()) break;
  }
  for (const ClWarning& warning : reader.warnings()) findings.add(warning);
  return findings;
}

TEST(Findings, OfAFileAreAllFoundInOnePassInTheOrderOfItsLines) {
  const auto findings = find_all(
      "GOTO/0,0,50\n"                // 1: no unit, no feed
      "FEDRAT/100,MMPM\n"            //
      "WOBBLE/1\n"                   // 3: unknown
      "CYCLE/TAP,FEDTO,5,RAPTO,2\n"  // 4: tapping
      "GOTO/1,0,0\n"                 //
      "FEDRAT/-4\n"                  // 6
      "WOBBLE/2\n"                   // 7: as 3
      "GOTO/2,0,0,0,0,7\n"           // 8: no unit vector
      "CIRCLE/9,9\n"                 // 9
      "GOTO/3,0,0\n"                 //
      "FINI\n");
  EXPECT_TRUE(findings.is_refused());
  const auto sorted = findings.sorted();
  std::vector<std::uint32_t> lines;
  for (const Finding& f : sorted) lines.push_back(f.line);
  EXPECT_EQ(lines, (std::vector<std::uint32_t>{1, 1, 3, 4, 6, 8, 9}));
  EXPECT_EQ(sorted[0].severity, Finding::Severity::kRefusal);
  EXPECT_NE(sorted[0].message.find("no FEDRAT"), std::string::npos);
  EXPECT_EQ(sorted[1].severity, Finding::Severity::kWarning);
  EXPECT_EQ(sorted[2].count, 2U);
  EXPECT_EQ(findings.refusals(), 7U);
}

TEST(Findings, BehindARefusedMotionDoNotComeOfIt) {
  const auto findings = find_all(
      "UNITS/MM\nFEDRAT/60\nGOTO/0,0,0\nGOTO/1,0\nCIRCLE/0,0,0,0,0,1,5\nGOTO/0,5,0\nGOTO/1,1,0\n"
      "FINI\n");
  EXPECT_EQ(findings.refusals(), 1U);
}

TEST(Findings, OfARefusedCycleAreOneWhateverItsHoles) {
  const auto findings = find_all(
      "UNITS/MM\nGOTO/0,0,50\nFEDRAT/60\nCYCLE/TAP,FEDTO,5,RAPTO,2\nGOTO/1,0,0\nGOTO/2,0,0\n"
      "CYCLE/OFF\nGOTO/3,0,50\nFINI\n");
  EXPECT_EQ(findings.refusals(), 2U);  // no feed in line 2, tapping in line 4
}

TEST(Findings, OfAlikeMessagesAreOne) {
  Findings findings;
  for (std::uint32_t line = 7; line > 4; --line) {
    findings.add(
        ClError{"f", line, "feed " + std::to_string(line) + " is bad", "mend it", {}, false});
  }
  findings.add(ClError{"f", 2, "something else", {}, {}, false});
  const auto sorted = findings.sorted();
  ASSERT_EQ(sorted.size(), 2U);
  EXPECT_EQ(to_text(sorted, "f"),
            "f:2: something else\nf:7: feed 7 is bad (3 places, first here); mend it\n");
}

TEST(Findings, OfOneGroupAreOneWhateverTheirMessages) {
  Findings findings;
  findings.add(ClError{"f", 3, "word A", {}, "words", false});
  findings.add(ClError{"f", 4, "word B", {}, "words", false});
  ASSERT_EQ(findings.sorted().size(), 1U);
  EXPECT_EQ(findings.sorted()[0].count, 2U);
}

TEST(Findings, BeyondTheirBoundAreCounted) {
  Findings findings;
  for (std::size_t i = 0; i < 300; ++i) {
    findings.add(ClError{"f", 1, std::string(i + 1, 'x'), {}, {}, false});
  }
  EXPECT_EQ(findings.sorted().size(), Findings::kMaxKinds);
  EXPECT_EQ(findings.refusals(), 300U);
}

TEST(Findings, AsJsonKeepLineMessageAndRemedy) {
  Findings findings;
  findings.add(ClError{"f", 3, "unknown word \"A\"", "drop it", {}, false});
  const std::string json = to_json(findings.sorted());
  EXPECT_NE(json.find(R"("line": 3, "severity": "refusal", "count": 1)"), std::string::npos)
      << json;
  EXPECT_NE(json.find(R"("message": "unknown word \"A\"")"), std::string::npos) << json;
  EXPECT_NE(json.find(R"("remedy": "drop it")"), std::string::npos) << json;
  EXPECT_EQ(to_json(Findings().sorted()), "[]");
}

}  // namespace
}  // namespace meridian::cl
