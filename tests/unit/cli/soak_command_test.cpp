// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "service/host/process/child_process.hpp"
#include "service/host/process/programs.hpp"
#include "support/command_output.hpp"

namespace meridian::test {
namespace {

namespace fs = std::filesystem;

void write_program(const fs::path& path, const std::string& line) {
  std::ofstream(path) << "#!/bin/sh\n" << line << "\n";
  fs::permissions(path, fs::perms::owner_all);
}

TEST(SoakCommand, StartsDrivesThatEndAtOnceNotAgainBeforeAPause) {
  const process::ScratchFolder beside;
  fs::copy_file(MERIDIAN_BINARY_DIR "/bin/meridian", beside.path() / "soaker");
  write_program(beside.path() / "meridian", "exit 1");
  write_program(beside.path() / "meridiand", "exec sleep 60");
  const CommandOutput soak =
      run_command("MERIDIAN_SHARE=" MERIDIAN_SOURCE_DIR "/deploy " +
                  (beside.path() / "soaker").string() + " soak --for 2s 2>&1");
  EXPECT_EQ(soak.exit_code, 1) << soak.output;
  const std::string ended = "the drives ended by themselves with code 1";
  const std::size_t first = soak.output.find(ended);
  ASSERT_NE(first, std::string::npos) << soak.output;
  EXPECT_EQ(soak.output.find(ended, first + 1), std::string::npos) << soak.output;
}

TEST(SoakCommand, RefusesAReportThatItsOwnTextWouldLieOver) {
  const process::ScratchFolder folder;
  const std::string report = (folder.path() / "soak.txt").string();
  const CommandOutput refused =
      run_command("MERIDIAN_SHARE=" MERIDIAN_SOURCE_DIR "/deploy " MERIDIAN_BINARY_DIR
                  "/bin/meridian soak --for 1s --report " +
                  report + " 2>&1");
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_NE(refused.output.find("--report: " + report), std::string::npos) << refused.output;
  EXPECT_TRUE(fs::is_empty(folder.path())) << "nothing is written";
}

TEST(SoakCommand, TakesWhatTheServiceFileSaysAndRefusesToEnforceWithoutRights) {
  const process::ScratchFolder folder;
  const std::string file = (folder.path() / "service.toml").string();
  std::ofstream(file) << "[service]\nmachine = \"none.toml\"\n[realtime]\nmode = \"enforce\"\n";
  const CommandOutput no_machine = run_tool("soak --for 1s --service " + file);
  EXPECT_NE(no_machine.output.find("none.toml"), std::string::npos) << no_machine.output;
  const std::string weak =
      "prlimit --rtprio=0:0 setpriv --bounding-set=-sys_nice --inh-caps=-sys_nice ";
  if (run_command(weak + "true 2>&1").exit_code != 0) GTEST_SKIP() << "no right to take rights";
  const CommandOutput refused =
      run_command("MERIDIAN_SHARE=" MERIDIAN_SOURCE_DIR "/deploy " + weak +
                  MERIDIAN_BINARY_DIR "/bin/meridian soak --for 1s --machine " MERIDIAN_SOURCE_DIR
                                      "/deploy/machines/lai.toml --service " +
                  file + " 2>&1");
  EXPECT_NE(refused.output.find("enforces real time, and here is no right to real-time priority"),
            std::string::npos)
      << refused.output;
  EXPECT_NE(refused.exit_code, 0);
}

/// A soak of programs that do nothing, whose report is looked at while it runs.
class KilledSoak : public testing::Test {
 protected:
  KilledSoak() {
    fs::copy_file(MERIDIAN_BINARY_DIR "/bin/meridian", folder_.path() / "soaker");
    write_program(folder_.path() / "meridian", "exec sleep 60");
    write_program(folder_.path() / "meridiand", "exec sleep 60");
    soak_ = std::make_unique<process::ChildProcess>(
        std::vector<std::string>{(folder_.path() / "soaker").string(), "soak", "--for", "1h",
                                 "--report", report_.string()},
        process::ChildProcess::Options{
            // Who is killed leaves his own scratch folder: inside of ours.
            .environment = {"MERIDIAN_SHARE=" MERIDIAN_SOURCE_DIR "/deploy",
                            "TMPDIR=" + folder_.path().string()},
            .error_file = (folder_.path() / "soak.log").string(),
            .output_file = (folder_.path() / "soak.out").string()});
  }

  [[nodiscard]] static std::string text_of(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// The report as it lies there; every report that lies there is whole.
  [[nodiscard]] nlohmann::json report() const { return nlohmann::json::parse(text_of(report_)); }
  /// Whether the report comes to say `what` within ten seconds.
  [[nodiscard]] bool waits_for(const std::function<bool(const nlohmann::json&)>& what) const {
    for (int i = 0; i < 1000; ++i) {
      if (fs::exists(report_) && what(report())) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  void expect_whole_report_after(int signal) {
    ASSERT_TRUE(waits_for([](const nlohmann::json& one) { return !one["over"].get<bool>(); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    soak_->send_signal(signal);
    EXPECT_EQ(soak_->wait_for_exit(std::chrono::seconds(20)), 1) << "no program was finished";
    const nlohmann::json last = report();
    EXPECT_TRUE(last["over"].get<bool>());
    EXPECT_TRUE(last["interrupted"].get<bool>());
    EXPECT_EQ(last["asked_s"].get<double>(), 3600);
    EXPECT_GE(last["elapsed_s"].get<double>(), 0.1) << "what was seen until then";
    EXPECT_LT(last["elapsed_s"].get<double>(), 60);
    const std::string text = text_of(folder_.path() / "soak.out");
    EXPECT_NE(text.find("s of 3600 s, interrupted"), std::string::npos) << text;
    EXPECT_NE(text.find("FAIL, interrupted after "), std::string::npos) << "to its last line";
    EXPECT_EQ(text, text_of(folder_.path() / "report.txt"));
  }

  const process::ScratchFolder folder_;
  const fs::path report_ = folder_.path() / "report.json";
  std::unique_ptr<process::ChildProcess> soak_;
};

TEST_F(KilledSoak, LeavesItsWholeReportWhereItIsAskedToEnd) { expect_whole_report_after(SIGTERM); }

TEST_F(KilledSoak, LeavesItsWholeReportWhereItIsInterrupted) { expect_whole_report_after(SIGINT); }

TEST_F(KilledSoak, LeavesAReportOfAMomentAgoWhereItIsKilled) {
  ASSERT_TRUE(waits_for([](const nlohmann::json&) { return true; })) << "there is one at once";
  EXPECT_LT(report()["elapsed_s"].get<double>(), 1);
  ASSERT_TRUE(waits_for([](const nlohmann::json& one) { return one["elapsed_s"] > 1.0; }));
  const double first_s = report()["elapsed_s"].get<double>();
  EXPECT_LT(first_s, 4) << "so old it may be";
  soak_->send_signal(SIGKILL);
  EXPECT_EQ(soak_->wait_for_exit(std::chrono::seconds(20)), 128 + SIGKILL);
  EXPECT_FALSE(report()["over"].get<bool>());
  EXPECT_GE(report()["elapsed_s"].get<double>(), first_s);
  EXPECT_NE(text_of(folder_.path() / "report.txt").find(" so far"), std::string::npos);
}

}  // namespace
}  // namespace meridian::test
