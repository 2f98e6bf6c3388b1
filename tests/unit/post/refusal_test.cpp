// SPDX-License-Identifier: Apache-2.0
// What cannot be said is refused with its line; nothing is guessed.
#include <gtest/gtest.h>

#include "unit/post/written.hpp"

namespace meridian {
namespace {

struct Wrong {
  const char* name;
  const char* machine;
  std::string text;
  std::uint32_t line;
  const char* reason;
};

TEST(PostRefusal, NamesLineAndReason) {
  const Wrong cases[] = {
      {"axis beyond the head", "lai", test::program_with("GOTO/100,0,0,1,0,0\n"), 5,
       "theta2 at 90"},
      {"far away", "lai", test::program_with("GOTO/5000,0,0\n"), 5, "b3"},
      {"half a turn", "bench", test::program_with("GOTO/0,0,0,0,0,-1\n"), 5, "half a turn"},
      {"unknown tool", "lai", test::program_with("LOADTL/77\n"), 5, "tool 77"},
      {"through coolant", "lai", test::program_with("COOLNT/THRU\n"), 5, "--through-coolant"},
      {"a vendor's word", "lai", test::program_with("SPINDL/ORIENT\n"), 5, "not translated"},
      {"unreadable", "lai", test::program_with("GOTO/1,2\n"), 5, "GOTO"},
  };
  for (const Wrong& wrong : cases) {
    const auto program = test::written(wrong.text, test::shipped(wrong.machine));
    ASSERT_FALSE(program) << wrong.name << " was written";
    EXPECT_EQ(program.error().line, wrong.line) << wrong.name;
    EXPECT_NE(program.error().message.find(wrong.reason), std::string::npos)
        << wrong.name << ": " << program.error().message;
  }
}

TEST(PostRefusal, AToleranceFinerThanTheWordsIsRefusedWithTheReason) {
  post::PostOptions options;
  options.chord_mm = 1e-5;
  const auto program = test::written(test::program_with("GOTO/100,7,0,0.36,0.48,0.8\n"),
                                     test::shipped("lai"), options);
  ASSERT_FALSE(program);
  EXPECT_NE(program.error().message.find("--chord-mm"), std::string::npos);
}

TEST(PostRefusal, AJointWithoutAWordIsNotGuessed) {
  MachineModel model = test::shipped("lai");
  model.joints[3].nc_word.clear();
  const auto program = test::written(test::program_with(""), model);
  ASSERT_FALSE(program);
  EXPECT_NE(program.error().message.find("theta1"), std::string::npos) << program.error().message;
  model.joints[3].nc_word.assign(1, 'X');
  const auto twice = test::written(test::program_with(""), model);
  ASSERT_FALSE(twice);
  EXPECT_NE(twice.error().message.find("same NC word X"), std::string::npos);
}

}  // namespace
}  // namespace meridian
