// SPDX-License-Identifier: Apache-2.0
#include "integration/set_up_words.hpp"

#include <filesystem>
#include <vector>

namespace meridian::test {

void SetUpWords::expect_accepted() {
  for (const dds::Reply& reply : {anna_.ask(frame()), bert_.ask(tools_), carl_.ask(limits())}) {
    EXPECT_TRUE(reply.is_accepted) << reply.text;
  }
  const dds::MachineInfo reported = reported_by(plant_);
  EXPECT_EQ(reported.work_frames, std::vector{frame().frame});
  EXPECT_EQ(reported.tool_file, tools_);
  EXPECT_EQ(reported.soft_limits.rows()[0], (SoftLimits::Row{true, -599, 599}));
}

void SetUpWords::expect_refused() {
  const dds::Status before = plant_.status();
  anna_.say(frame(), before);
  bert_.say(tools_, before);
  carl_.say(limits(), before);
  for (SetUpOperator* const asks : {&anna_, &bert_, &carl_}) {
    const auto reply = asks->answer();
    ASSERT_TRUE(reply) << plant_.standing();
    const bool is_for_the_state =
        reply->refusal == Refusal::kWrongState || reply->refusal == Refusal::kProgramPresent;
    EXPECT_TRUE(!reply->is_accepted && is_for_the_state) << reply->text;
  }
  const dds::Status after = plant_.status();
  EXPECT_EQ(after.frame, before.frame);
  EXPECT_EQ(after.tools, before.tools);
  EXPECT_EQ(after.limits, before.limits);
  EXPECT_FALSE(std::filesystem::exists(plant_.state() / "lai.setup"));
}

}  // namespace meridian::test
