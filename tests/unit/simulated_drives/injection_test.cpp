// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/injection.hpp"

#include <gtest/gtest.h>

#include "meridian/units.hpp"
#include "support/machines.hpp"

namespace meridian::drives {
namespace {

TEST(Injection, IsReadWithItsTimeDriveAndValue) {
  const MachineModel model = test::lai_machine();
  const auto spike = parse_injection("spike@2.5:theta1=-30", model);
  ASSERT_TRUE(spike.has_value()) << spike.error();
  EXPECT_EQ(spike->kind, Injection::Kind::kSpike);
  EXPECT_EQ(spike->after_s, 2.5);
  EXPECT_EQ(spike->drive, 3);
  EXPECT_DOUBLE_EQ(spike->value, units::rad_from_deg(-30));
  const auto deaf = parse_injection("deaf=7", model);
  ASSERT_TRUE(deaf.has_value()) << deaf.error();
  EXPECT_EQ(deaf->after_s, 0);
  EXPECT_EQ(deaf->value, 7);
  const auto lag = parse_injection("lag:b2=250", model);
  ASSERT_TRUE(lag.has_value()) << lag.error();
  EXPECT_EQ(lag->value, 0.25);
  EXPECT_TRUE(parse_injection("fault@0", model).has_value());
}

TEST(Injection, EveryWordIsReadAlone) {
  for (const InjectionWord& word : injection_words()) {
    const auto injection = parse_injection(word.word, test::lai_machine());
    ASSERT_TRUE(injection.has_value()) << injection.error();
    EXPECT_EQ(injection->kind, word.kind) << word.word;
    EXPECT_EQ(injection->value == 0, word.unit == nullptr) << word.word;
  }
}

TEST(Injection, ThatIsWrongIsRefusedInWords) {
  const struct {
    const char* text;
    const char* why;
  } wrong[] = {{"", "KIND is one of"},          {"explode@1", "KIND is one of"},
               {"fault@soon", "seconds"},       {"fault@-1", "seconds"},
               {"fault@nan", "seconds"},        {"fault@1:x9", "no drive x9"},
               {"silence@1:b2", "of no drive"}, {"fault@1:b2=3", "takes no value"},
               {"lag:b2=long", "stand ms"},     {"deaf=-3", "not negative"},
               {"spike:b2=1e300", "mm or deg"}};
  for (const auto& [text, why] : wrong) {
    const auto injection = parse_injection(text, test::lai_machine());
    ASSERT_FALSE(injection.has_value()) << text;
    EXPECT_NE(injection.error().find(why), std::string::npos) << injection.error();
  }
}

}  // namespace
}  // namespace meridian::drives
