// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/check/drive_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

#include "support/machines.hpp"
#include "unit/simulated_drives/faulty_drives.hpp"
#include "unit/simulated_drives/naive_drives.hpp"

namespace meridian::drives {
namespace {

CheckReport check(const std::string& fault, int lost = 0) {
  const MachineModel model = test::lai_machine();
  test::FaultyDrives drives(model, fault, lost);
  return DriveCheck(model, drives).run(Operator::kThere);
}

std::string names(const CheckReport& report) {
  std::string text;
  for (const Finding& one : report.findings) {
    text += std::string(text_of(one.rule).name) + " (" + one.seen + ") ";
  }
  return text;
}

TEST(DriveCheck, DrivesOfTheLibraryBreakNoRule) {
  const CheckReport report = check("");
  EXPECT_TRUE(report.has_drives);
  EXPECT_EQ(names(report), "");
  EXPECT_TRUE(report.unproven.empty());
}

/// Bridge and ramp may be in one report then.
TEST(DriveCheck, DrivesOfTheLibraryBreakNoRuleWhereTheirProcessLosesPeriodsInAStop) {
  for (const int lost : {5, 15, 21, 25, 31, 50}) EXPECT_EQ(names(check("", lost)), "") << lost;
}

/// Positions that are copied are no drive: everything that keeps a machine safe is missing.
TEST(DriveCheck, ANaiveClientThatOnlyCopiesPositionsBreaksEveryRuleOfSafety) {
  const MachineModel model = test::lai_machine();
  test::NaiveDrives drives(model);
  const CheckReport report = DriveCheck(model, drives).run(Operator::kThere);
  std::set<Rule> broken;
  for (const Finding& one : report.findings) broken.insert(one.rule);
  for (const Rule rule : {Rule::kNotEnabledSetpoint,
                          Rule::kOrder,
                          Rule::kDoubled,
                          Rule::kChecksum,
                          Rule::kLate,
                          Rule::kDryRun,
                          Rule::kForeignSetpoint,
                          Rule::kForeignCommand,
                          Rule::kBridge,
                          Rule::kWatchdog,
                          Rule::kKilled,
                          Rule::kNoNumber,
                          Rule::kTravel,
                          Rule::kVelocity,
                          Rule::kStep,
                          Rule::kBegin,
                          Rule::kEmergencyStop,
                          Rule::kKeepsMaster,
                          Rule::kRestart,
                          Rule::kFreesMaster}) {
    EXPECT_TRUE(broken.contains(rule)) << text_of(rule).name << " of " << names(report);
  }
}

struct Fault {
  const char* name;
  Rule rule;
};

constexpr Fault kFaults[] = {
    {"joint-missing", Rule::kAllDrives},
    {"joint-too-many", Rule::kKnownJoints},
    {"rare", Rule::kInTime},
    {"sample-stands", Rule::kSampleCounts},
    {"no-number-reported", Rule::kNumbers},
    {"jumps", Rule::kNoJump},
    {"never-enables", Rule::kWalksUp},
    {"nobody-named", Rule::kNamesMaster},
    {"jerks-when-enabled", Rule::kStandsWhenEnabled},
    {"no-cycle", Rule::kCycleSeen},
    {"follows-all", Rule::kNotEnabledSetpoint},
    {"does-not-follow", Rule::kFollows},
    {"no-order", Rule::kOrder},
    {"takes-the-same-again", Rule::kDoubled},
    {"no-checksum", Rule::kChecksum},
    {"no-age", Rule::kLate},
    {"follows-dry-runs", Rule::kDryRun},
    {"takes-setpoints-of-all", Rule::kForeignSetpoint},
    {"trusts-the-id", Rule::kForeignCommand},
    {"no-bridge", Rule::kBridge},
    {"bridges-standing", Rule::kBridge},
    {"no-watchdog", Rule::kWatchdog},
    {"other-error", Rule::kWatchdog},
    {"no-ramp", Rule::kRamp},
    {"long-ramp", Rule::kRamp},
    {"jumps-into-its-ramp", Rule::kKilled},
    {"jumps-back-after-its-ramp", Rule::kKilled},
    {"creeps-after-its-ramp", Rule::kKilled},
    {"resets-by-itself", Rule::kFaultStays},
    {"no-reset", Rule::kFaultReset},
    {"resets-by-level", Rule::kResetEdge},
    {"takes-no-numbers", Rule::kNoNumber},
    {"no-travel", Rule::kTravel},
    {"limits-velocity", Rule::kVelocity},
    {"no-step", Rule::kStep},
    {"no-begin", Rule::kBegin},
    {"no-quick-stop", Rule::kQuickStop},
    {"no-disable", Rule::kDisableVoltage},
    {"no-shutdown", Rule::kShutdown},
    {"no-homing-mode", Rule::kModeDisplay},
    {"mode-not-reported", Rule::kModeDisplay},
    {"no-cycle-in-homing", Rule::kHomingCycle},
    {"keeps-its-reference", Rule::kReferenceLost},
    {"loses-its-reference", Rule::kReferenceFound},
    {"takes-the-newest-when-off", Rule::kKeepsMaster},
    {"hides-its-stop", Rule::kEmergencyStop},
    {"forgets-its-stop", Rule::kEmergencyStop},
    {"drops-off-when-alone", Rule::kGoneInMotion},
    {"obeys-a-restarted-service", Rule::kRestart},
    {"takes-commands-of-all", Rule::kForeignCommand},
    {"keeps-a-service-that-is-gone", Rule::kFreesMaster},
};

class FaultyClient : public testing::TestWithParam<Fault> {};

TEST_P(FaultyClient, IsNamedByItsRuleFirst) {
  const CheckReport report = check(GetParam().name);
  ASSERT_FALSE(report.findings.empty());
  EXPECT_EQ(report.findings.front().rule, GetParam().rule)
      << GetParam().name << " should break " << text_of(GetParam().rule).name << ", and broke "
      << names(report);
}

INSTANTIATE_TEST_SUITE_P(Seeded, FaultyClient, testing::ValuesIn(kFaults), [](const auto& fault) {
  std::string name = fault.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(DriveCheck, EveryRuleButOneHasAFaultyClient) {
  std::set<Rule> seeded;
  for (const Fault& fault : kFaults) seeded.insert(fault.rule);
  for (const RuleText& rule : check_rules()) {
    if (rule.rule == Rule::kNextMaster) continue;  // broken with kFreesMaster
    EXPECT_TRUE(seeded.contains(rule.rule)) << rule.name;
  }
}

TEST(DriveCheck, EveryRuleNamesAPageThatIsThere) {
  for (const RuleText& rule : check_rules()) {
    const std::string page = rule.page;
    EXPECT_TRUE(std::filesystem::exists(MERIDIAN_SOURCE_DIR "/" + page.substr(0, page.find(','))))
        << page;
  }
}

}  // namespace
}  // namespace meridian::drives
