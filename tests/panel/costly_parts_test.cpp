// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/costly_parts.hpp"

#include <gtest/gtest.h>

namespace meridian::panel {
namespace {

using Clock = CostlyParts::Clock;

TEST(CostlyParts, WhoAsksWhileAnotherAnswerIsMadeHasToAskAgain) {
  CostlyParts costly({});
  const auto outer = costly.one_at_a_time([&]() -> std::optional<HttpAnswer> {
    const auto inner = costly.one_at_a_time([] { return HttpAnswer{.text = "twice"}; });
    EXPECT_EQ(inner->status, 503);
    return HttpAnswer{.text = "once"};
  });
  EXPECT_EQ(outer->text, "once");
  EXPECT_EQ(costly.one_at_a_time([] { return HttpAnswer{.text = "then"}; })->text, "then");
}

TEST(CostlyParts, TheHostIsExaminedNoOftenerThanItMatters) {
  int examined = 0;
  CostlyParts costly([&examined] { return std::to_string(++examined); });
  const Clock::time_point begin = Clock::now();
  EXPECT_EQ(costly.host_findings(begin)->text, "1");
  EXPECT_EQ(costly.host_findings(begin + CostlyParts::kFresh)->text, "1");
  EXPECT_EQ(costly.host_findings(begin + 2 * CostlyParts::kFresh)->text, "2");
  EXPECT_FALSE(CostlyParts({}).host_findings(begin));
}

}  // namespace
}  // namespace meridian::panel
