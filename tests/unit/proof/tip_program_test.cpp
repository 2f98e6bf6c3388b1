// SPDX-License-Identifier: Apache-2.0
// A posted program of tool-centre words passes in every dialect; spoilt ones fail.
#include "service/programs/proof/tip_program.hpp"

#include <gtest/gtest.h>

#include "service/programs/nc/nc_reader.hpp"
#include "service/programs/proof/program_check.hpp"
#include "unit/post/written.hpp"

namespace meridian {
namespace {

const std::string kArcPart =
    "UNITS/MM\nMULTAX/ON\nLOADTL/1\nFEDRAT/1200,MMPM\nRAPID\nGOTO/30,0,20,0,0,1\n"
    "GOTO/30,0,0,0,0,1\nGOTO/30,30,5,0.1,0.05,0.9937303457\n"
    "CIRCLE/20,30,5,0,0,1,10\nGOTO/20,40,5,-0.1,0.1,0.9899494937\n"
    "RAPID\nGOTO/20,60,40,-0.1,0.1,0.9899494937\nFINI\n";

/// A machine whose controls know its kinematics, and a dialect of theirs.
struct Case {
  const char* name;
  post::Dialect dialect;
  bool has_vectors;
  cl::Dialect words;
};

class TipProgramCheck : public testing::TestWithParam<Case> {
 protected:
  const MachineModel model_ = test::shipped("trunnion-ac");
  const ToolTable tools_{{{1, model_.tool_length_mm, 5}}};

  std::vector<ClBlock> read(const std::string& text, const cl::ClReaderOptions& options) {
    std::vector<ClBlock> blocks;
    cl::ClReader reader(text, "part", options);
    for (auto block = reader.next();; block = reader.next()) {
      EXPECT_TRUE(block) << block.error().text() << "\n" << text;
      if (!block || !*block) return blocks;
      blocks.push_back(**block);
    }
  }

  std::string posted() {
    post::PostOptions options;
    options.dialect = GetParam().dialect;
    options.has_vectors = GetParam().has_vectors;
    const auto program = test::written(kArcPart, model_, options);
    EXPECT_TRUE(program) << program.error().message;
    return program ? program->text : "";
  }

  proof::ProgramReport checked(const std::string& program) {
    MachineModel fine = model_;
    fine.tolerances.axis_rad *= proof::kFinerTurns;
    cl::ClReaderOptions options;
    options.dialect = GetParam().words;
    options.nc = nc::reader_of_programs(fine, tools_);
    return proof::check_program(proof::steps_of_tip(read(program, options)), read(kArcPart, {}),
                                model_, tools_, {});
  }
};

TEST_P(TipProgramCheck, PassesAsItWasPosted) {
  const proof::ProgramReport report = checked(posted());
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_GT(report.moves, 2U);
  EXPECT_EQ(report.motions, 5U);
}

/// One digit of the first number after the last `address` of the program.
std::string with_a_wrong_digit(std::string program, const std::string& address) {
  const std::size_t at = program.rfind(address);
  const std::size_t digit = program.find_first_of("0123456789", at + address.size());
  EXPECT_NE(digit, std::string::npos);
  program[digit] = program[digit] == '9' ? '8' : static_cast<char>(program[digit] + 1);
  return program;
}

TEST_P(TipProgramCheck, FailsWhereATipOrAnAxisIsWrong) {
  const std::string program = posted();
  for (const char* const address : {" Y", GetParam().name}) {
    const proof::ProgramReport report = checked(with_a_wrong_digit(program, address));
    EXPECT_FALSE(report.passed()) << address;
  }
}

// The name is that of a word of the tool axis.
INSTANTIATE_TEST_SUITE_P(
    Dialects, TipProgramCheck,
    testing::Values(Case{" A", post::Dialect::kFanuc, false, cl::Dialect::kFanuc},
                    Case{" J", post::Dialect::kFanuc, true, cl::Dialect::kFanuc},
                    Case{" B3=", post::Dialect::kSiemens, true, cl::Dialect::kSiemens},
                    Case{" TY", post::Dialect::kHeidenhain, true, cl::Dialect::kHeidenhain}),
    [](const auto& one) { return "Case" + std::to_string(one.index); });

}  // namespace
}  // namespace meridian
