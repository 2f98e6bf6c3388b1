// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/source_reporter.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/machines.hpp"

namespace meridian::interpolator {
namespace {

constexpr std::int64_t kTick_ns = 1'000'000;

class SourceReporterTest : public testing::Test {
 protected:
  /// What is said of the sources as they are now.
  std::vector<std::string> look() {
    std::vector<std::string> said;
    now_ns_ += kTick_ns;
    reporter_.look(
        sources_, now_ns_, [](std::uint64_t writer) { return "process " + std::to_string(writer); },
        [] { return std::string("process 99"); },
        [&said](telemetry::Weight, const std::string& text) { said.push_back(text); });
    return said;
  }
  /// A source that has spoken just now, and from the begin on.
  DriveSource& source(std::size_t slot, std::uint64_t writer, std::uint32_t claimed,
                      std::uint32_t bound) {
    DriveSource& source = sources_.slots[slot];
    source.writer = writer;
    source.group = 3;
    source.claimed_mask = claimed;
    source.bound_mask = bound;
    if (source.first_ns == 0) source.first_ns = now_ns_;
    source.arrival_ns = now_ns_ + 1;
    return source;
  }

  const MachineModel model_ = test::lai_machine();
  SourceReporter reporter_{model_, 7};
  DriveSources sources_;
  std::int64_t now_ns_ = kTick_ns;
};

using Said = std::vector<std::string>;

TEST_F(SourceReporterTest, SaysOnceWhoReportsAndWhoIsGone) {
  source(0, 11, 0b11, 0b11);
  EXPECT_EQ(look(), Said{"drive group 3 of process 11 reports b3, b2"});
  EXPECT_EQ(look(), Said{});
  sources_.slots[0] = {};
  EXPECT_EQ(look(), Said{"drive group 3 of process 11 is gone"});
}

TEST_F(SourceReporterTest, SaysOnceThatAGuardCountsAsOpenBecauseNobodySpeaksOfIt) {
  source(0, 11, 0b11, 0b11).guard = GuardInput::kShut;
  (void)look();
  now_ns_ += 300 * kTick_ns;
  EXPECT_EQ(look(), Said{"drive group 3 of process 11 says nothing any more: its guard counts as "
                         "open until it does, or another one for its group"});
  EXPECT_EQ(look(), Said{});
  source(0, 11, 0b11, 0b11);
  EXPECT_EQ(look(), Said{});
}

TEST_F(SourceReporterTest, NamesBothWhereTwoReportTheSameDrive) {
  source(0, 11, 0b11, 0b11);
  (void)look();
  source(1, 12, 0b10, 0);
  source(0, 11, 0b11, 0b11).arrival_ns += 5;
  const Said said = look();
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0].rfind("two report b2: drive group 3 of process 11 keeps them; drive group 3 of "
                          "process 12 is refused",
                          0),
            0U)
      << said[0];
  EXPECT_EQ(look(), Said{});
  now_ns_ += 1'000'000'000;
  source(0, 11, 0b11, 0b11);
  EXPECT_EQ(look(), Said{"drive group 3 of process 12 reports no other one's drives any more"});
}

TEST_F(SourceReporterTest, SaysWhatIsTakenFromWhoHasNoDriveOfTheMachine) {
  source(0, 11, 0, 0);
  source(1, 12, 0, 0).has_only_stop = true;
  const Said said = look();
  ASSERT_EQ(said.size(), 2U);
  EXPECT_NE(said[0].find("reports no drive that this machine has"), std::string::npos) << said[0];
  EXPECT_EQ(said[1], "drive group 3 of process 12 reports a stop input and no drive");
}

TEST_F(SourceReporterTest, SaysOnceWhoseDrivesObeyAnotherServiceAndWhoMayBeThat) {
  source(0, 11, 0b11, 0b11).master = 7;
  EXPECT_EQ(look(), Said{"drive group 3 of process 11 reports b3, b2"}) << "they obey this one";
  source(0, 11, 0b11, 0b11).master = 0x1234;
  const Said said = look();
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0],
            "drive group 3 of process 11 obeys service 0000000000001234, not this one "
            "(0000000000000007): b3, b2 cannot be enabled. Drive commands are written by process "
            "99: end that one");
  EXPECT_EQ(look(), Said{});
  source(0, 11, 0b11, 0b11).master = 7;
  EXPECT_EQ(look(), Said{"drive group 3 of process 11 obeys no other service any more"});
}

}  // namespace
}  // namespace meridian::interpolator
