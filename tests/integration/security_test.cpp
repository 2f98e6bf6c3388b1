// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "integration/plant.hpp"
#include "support/private_domain.hpp"

namespace meridian::test {
namespace {

using Words = std::vector<std::string>;
using Set = std::set<std::string>;
using Running = std::unique_ptr<Process>;

[[nodiscard]] int shell(const std::string& command) {
  return std::system((command + " 2>&1").c_str());
}

/// Somebody who tries everything, and what the others let through.
struct Rogue {
  std::string identity;
  std::string how;  ///< harm only where nothing is rightly its own
  Set may;
};

/// A secured machine: two authorities in a folder of the test, service and drives with their
/// identities, everything else as a process with the identity that a test gives it. The test has
/// none and looks through the eyes of a viewer.
class Security : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::filesystem::temp_directory_path() / ("meridian-security-" + domain());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    const std::string make = std::string(MERIDIAN_SOURCE_DIR) + "/deploy/security/make_identities ";
    const std::string log = " >>" + (folder_ / "make.log").string();
    ASSERT_EQ(shell(make + (folder_ / "ours").string() + " lai" + log), 0);
    ASSERT_EQ(shell(make + (folder_ / "ours").string() + " mill mill-operator=operator" + log), 0);
    ASSERT_EQ(shell(make + (folder_ / "theirs").string() + " lai operator" + log), 0);
    for (const char* role : {"viewer", "station", "operator"}) make_lax(role);
    // A dozen programs that shake hands at once may keep service and drives from a small host's
    // processors for longer than the shipped patience; who may do what is not a matter of time.
    std::ofstream(folder_ / "service.toml")
        << "[service]\nmachine = \"" << machine_file()
        << "\"\nfeedback_timeout_s = 10\nbridge_cycles = 1000\n";
    service_ = start("ours/service", "service",
                     {"meridiand", "--service", folder_ / "service.toml", "--domain", domain(),
                      "--record", recording(), "--best-effort"});
    drives_ = start("ours/drives", "drives",
                    {"meridian", "drives", "--machine", machine_file(), "--domain", domain()});
    ASSERT_TRUE(
        eventually([] { return service_->said().find("answering in Off") != std::string::npos; },
                   milliseconds(15'000)))
        << service_->said();
  }
  static void TearDownTestSuite() {
    drives_.reset();
    service_.reset();
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  /// The role with a governance of its own that its authority signed and that demands no
  /// permissions: as somebody who broke the checks of his own process.
  static void make_lax(const std::string& role) {
    const std::string own = folder_ / ("lax-" + role), ours = folder_ / "ours";
    const std::string strict = std::string(MERIDIAN_SOURCE_DIR) + "/deploy/security/governance.xml";
    ASSERT_EQ(shell("cp -r " + ours + "/" + role + " " + own +
                    " && sed 's/_access_control>true/"
                    "_access_control>false/' " +
                    strict + " >" + own +
                    "/lax.xml && openssl smime "
                    "-sign -text -in " +
                    own + "/lax.xml -out " + own + "/governance.p7s -signer " + ours +
                    "/authority/cert.pem -inkey " + ours +
                    "/authority/key.pem && sed -i "
                    "'s|ours/" +
                    role + "|lax-" + role + "|g' " + own + "/cyclonedds.xml"),
              0);
  }

  /// A program with an identity, or with none.
  [[nodiscard]] static Running start(const std::string& identity, const std::string& log,
                                     const Words& words) {
    if (identity.empty()) {
      ::unsetenv("CYCLONEDDS_URI");
    } else {
      const std::string uri = "file://" + (folder_ / identity / "cyclonedds.xml").string();
      ::setenv("CYCLONEDDS_URI", uri.c_str(), 1);
    }
    auto process = std::make_unique<Process>(words, folder_ / (log + ".log"));
    ::unsetenv("CYCLONEDDS_URI");
    return process;
  }
  [[nodiscard]] static Running tool(const std::string& identity, const std::string& log,
                                    const Words& words) {
    Words all = {"meridian"};
    all.insert(all.end(), words.begin(), words.end());
    for (const char* word : {"--machine-name", "lai", "--domain"}) all.emplace_back(word);
    all.push_back(domain());
    return start(identity, log, all);
  }
  /// Runs it to its end: exit code and what it said.
  [[nodiscard]] static std::pair<int, std::string> run(const std::string& identity,
                                                       const Words& words) {
    static int count = 0;
    const Running process = tool(identity, "tool-" + std::to_string(++count), words);
    const auto code = process->wait(milliseconds(25'000));
    return {code.value_or(-1), process->said()};
  }
  [[nodiscard]] static std::string status() { return run("ours/viewer", {"status"}).second; }
  /// The line of it that begins with `word`.
  [[nodiscard]] static std::string line(const std::string& text, const std::string& word) {
    std::istringstream lines(text);
    for (std::string one; std::getline(lines, one);) {
      if (one.starts_with(word)) return one;
    }
    return "";
  }

  static void expect_through(const std::vector<Rogue>& rogues) {
    std::vector<Running> running;
    for (const Rogue& rogue : rogues) {
      std::string log = "rogue-" + rogue.identity + rogue.how;
      std::replace(log.begin(), log.end(), '/', '-');
      running.push_back(start(rogue.identity, log, {"rogue", domain(), "lai", rogue.how}));
    }
    for (std::size_t i = 0; i < rogues.size(); ++i) {
      ASSERT_EQ(running[i]->wait(milliseconds(30'000)), 0) << running[i]->said();
      Set through;
      std::istringstream lines(running[i]->said());
      for (std::string one; std::getline(lines, one);) {
        if (one.starts_with("writes ") || one.starts_with("reads ")) through.insert(one);
      }
      EXPECT_EQ(through, rogues[i].may) << "'" << rogues[i].identity << "' said\n"
                                        << running[i]->said();
    }
  }

  static void expect_roles_enforced();
  static void expect_programs_refused();
  static void expect_a_viewers_panel_watches();
  static void cut_a_program();

  [[nodiscard]] static std::string domain() { return std::to_string(domain_->id()); }
  [[nodiscard]] static std::string recording() { return folder_ / "recording.csv"; }

  static inline std::unique_ptr<support::PrivateDomain> domain_ =
      std::make_unique<support::PrivateDomain>();
  static inline std::filesystem::path folder_;
  static inline Running service_, drives_;
};

void Security::expect_roles_enforced() {
  EXPECT_NE(service_->said().find("secured: "), std::string::npos) << service_->said();
  const auto enabled = run("ours/operator", {"ctl", "enable", "--wait", "Ready"});
  ASSERT_EQ(enabled.first, 0) << enabled.second << service_->said();
  const std::string before = status();
  ASSERT_NE(before.find("machine   lai: Ready"), std::string::npos) << before;
  ASSERT_NE(before.find(", secured"), std::string::npos) << before;

  const Set seen_by_viewer = {"reads status", "reads machine", "reads latency", "reads setpoint",
                              "reads feedback"};
  // Those who break the rules must not find each other: who writes and who reads come in turns.
  expect_through(
      {{"", "ws", {}},
       {"theirs/operator", "ws", {}},
       {"lax-viewer", "ws", {}},
       {"lax-station", "ws", {}},
       {"lax-operator", "ws", {}},
       {"ours/mill-operator", "ws", {}},
       {"ours/plc", "wr", {"writes action_done", "reads status", "reads machine"}},
       {"ours/drives",
        "wr",
        {"writes feedback", "writes action_done", "reads setpoint", "reads drive_command",
         "reads feedback", "reads machine"}},
       {"ours/viewer", "wrs", seen_by_viewer},
       {"ours/station",
        "wr",
        {"writes cl_session", "writes cl_batch", "reads status", "reads machine"}},
       {"ours/operator",
        "wr",
        {"writes command", "writes jog", "reads status", "reads machine", "reads latency"}}});
  expect_through({{"", "r", {}},
                  {"theirs/operator", "r", {}},
                  {"lax-viewer", "r", {}},
                  {"ours/mill-operator", "r", {}},
                  {"ours/viewer", "r", seen_by_viewer}});
  const std::string after = status();
  EXPECT_NE(after.find("machine   lai: Ready"), std::string::npos) << after << service_->said();
  EXPECT_EQ(line(before, "joints"), line(after, "joints"));
  EXPECT_EQ(drives_->said().find("fault"), std::string::npos) << drives_->said();
  EXPECT_EQ(service_->said().find("refused"), std::string::npos) << "it never heard of them";
  for (const Process* process : {service_.get(), drives_.get()}) {
    EXPECT_NE(process->said().find("security_attributes mismatch"), std::string::npos)
        << "what was refused is logged\n"
        << process->said();
  }
}

/// The role is that of the identity. A build without the panel has nothing to show.
void Security::expect_a_viewers_panel_watches() {
  if (run("ours/viewer", {"panel", "--help"}).first != 0) return;
  for (const auto& [role, watches] : {std::pair{"viewer", true}, {"panel", false}}) {
    const Running panel = tool(std::string("ours/") + role, std::string("panel-") + role,
                               {"panel", "--port", "0", "--timeout", "20"});
    EXPECT_TRUE(eventually(
        [&panel] { return panel->said().find("http://127.0.0.1") != std::string::npos; },
        milliseconds(25'000)))
        << panel->said();
    std::this_thread::sleep_for(milliseconds(200));
    EXPECT_EQ(panel->said().find("it only watches: ") != std::string::npos, watches)
        << panel->said();
  }
}

/// The programs themselves say what is refused, and the remedy.
void Security::expect_programs_refused() {
  const auto command = run("ours/viewer", {"ctl", "hold"});
  EXPECT_NE(command.first, 0);
  EXPECT_NE(command.second.find("meridian/command cannot be used: the permissions"),
            std::string::npos)
      << command.second;
  const auto stream =
      run("ours/operator", {"stream", MERIDIAN_SOURCE_DIR "/deploy/parts/blossom.apt"});
  EXPECT_NE(stream.first, 0);
  EXPECT_NE(stream.second.find("meridian/cl_"), std::string::npos) << stream.second;
  expect_a_viewers_panel_watches();
  const auto stranger = run("", {"status", "--timeout", "2"});
  EXPECT_NE(stranger.first, 0) << stranger.second;
  EXPECT_NE(stranger.second.find("no service answers"), std::string::npos) << stranger.second;
}

void Security::cut_a_program() {
  const auto enabled = run("ours/operator", {"ctl", "enable", "--wait", "Ready"});
  ASSERT_TRUE(status().find("lai: Ready") != std::string::npos)
      << enabled.second << service_->said();
  const std::string part = folder_ / "part.apt";
  std::ofstream(part) << "PARTNO SMALL PROGRAM\nUNITS/MM\nFEDRAT/1000,MMPM\n"
                      << cl_text(small_program(16, 1000)) << "FINI\n";
  const Running station = tool("ours/station", "station", {"stream", part, "--wait-end"});
  ASSERT_TRUE(
      eventually([] { return status().find("Loaded") != std::string::npos; }, milliseconds(15'000)))
      << station->said();
  const auto started = run("ours/operator", {"ctl", "start"});
  ASSERT_EQ(started.first, 0) << started.second;
  EXPECT_EQ(station->wait(milliseconds(30'000)), 0) << station->said() << service_->said();
  service_->send_signal(SIGTERM);
  ASSERT_EQ(service_->wait(milliseconds(12'000)), 0) << service_->said();
  Process check({"meridian", "check", recording(), part, "--machine", machine_file(),
                 "--max-missing", "1000000"},
                folder_ / "check.log");
  EXPECT_EQ(check.wait(milliseconds(30'000)), 0) << check.said();
}

/// One test, so that the plant is built once.
TEST_F(Security, LetsEachRoleDoItsOwnAndNobodyElseAnything) {
  ASSERT_NO_FATAL_FAILURE(expect_roles_enforced());
  ASSERT_NO_FATAL_FAILURE(expect_programs_refused());
  ASSERT_NO_FATAL_FAILURE(cut_a_program());
}

}  // namespace
}  // namespace meridian::test
