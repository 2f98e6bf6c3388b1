// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/controls/nc_text.hpp"

#include <gtest/gtest.h>

namespace meridian::post {
namespace {

TEST(NcText, NumbersHaveAPointAndNoExponentAndNoNegativeZero) {
  EXPECT_EQ(fixed(1e-7, 4), "0.0000");
  EXPECT_EQ(fixed(-1e-7, 4), "0.0000");
  EXPECT_EQ(fixed(123456789.0, 3), "123456789.000");
  EXPECT_EQ(fixed(-0.00006, 4), "-0.0001");
}

TEST(NcText, FeedsAreRoundedDown) {
  EXPECT_EQ(fixed_down(239.9999, 3), "239.999");
  EXPECT_EQ(fixed_down(240.0, 3), "240.000");
}

TEST(NcText, AMessageCannotEndItsCommentOrBecomeACommand) {
  EXPECT_EQ(harmless("a) G0 Z-100 (b"), "a_ G0 Z-100 _b");
  EXPECT_EQ(harmless("x\nM30 %;~"), "x_M30 ___");
  EXPECT_EQ(harmless(std::string(200, 'a')).size(), 64U);
}

}  // namespace
}  // namespace meridian::post
