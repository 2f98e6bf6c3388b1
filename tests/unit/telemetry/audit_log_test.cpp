// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/audit_log.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/text_file.hpp"

namespace meridian::telemetry {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, gone with this object.
class AuditFolder {
 public:
  AuditFolder()
      : path_(fs::temp_directory_path() / ("meridian-audit-" + std::to_string(::getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~AuditFolder() { fs::remove_all(path_); }
  AuditFolder(const AuditFolder&) = delete;
  AuditFolder& operator=(const AuditFolder&) = delete;
  [[nodiscard]] fs::path file() const { return path_ / "lai.audit.log"; }

 private:
  fs::path path_;
};

AuditEntry hold_of(std::uint64_t request) {
  return {.time_ns = 1'790'000'000'123'456'789,
          .identity = "process 7 on host hmi",
          .operator_name = "panel",
          .operator_id = 0xFEDC,
          .request = request,
          .verb = Verb::kHold,
          .is_accepted = true,
          .state = State::kRunning};
}

/// What `body` leaves in the file, and what the log complains of.
template <class Body>
std::vector<std::string> while_written(AuditLog& log, Body body) {
  std::vector<std::string> complaints;
  std::thread writer(
      [&] { log.run([&](const std::string& text) { complaints.push_back(text); }); });
  body();
  log.stop();
  writer.join();
  return complaints;
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(AuditLine, SaysWhoDidWhatAndWhatCameOfIt) {
  EXPECT_EQ(to_line(hold_of(12)),
            R"({"time":"2026-09-21T14:13:20.123Z","event":"command","verb":"hold","argument":0,)"
            R"("result":"accepted","state":"Running","name":"panel",)"
            R"("operator_id":"000000000000fedc","request":12,"from":"process 7 on host hmi"})"
            "\n");
  AuditEntry refused = hold_of(13);
  refused.is_accepted = false;
  refused.refusal = Refusal::kStale;
  refused.text = "look again";
  const std::string line = to_line(refused);
  EXPECT_NE(line.find(R"("result":"refused","refusal":"stale")"), std::string::npos) << line;
  EXPECT_NE(line.find(R"("text":"look again")"), std::string::npos) << line;
  AuditEntry fault{.text = "drive b3 reports a fault", .kind = AuditKind::kFault};
  fault.state = State::kFault;
  EXPECT_EQ(to_line(fault).find("verb"), std::string::npos);
  EXPECT_NE(to_line(fault).find(R"("event":"fault","state":"Fault")"), std::string::npos);
}

TEST(AuditLine, IsOneLineWhateverItsTextsHold) {
  AuditEntry forged = hold_of(1);
  forged.operator_name = "x\"}\n{\"time\":\"2026-01-01\",\"event\":\"command\"}\x1b[2J";
  forged.text = std::string("\0\x9b\xC2\x9B\\", 5);
  forged.verb = static_cast<Verb>(200);
  forged.state = static_cast<State>(99);
  forged.argument = std::numeric_limits<double>::quiet_NaN();
  const std::string line = to_line(forged);
  EXPECT_EQ(lines_of(line), 1U);
  EXPECT_TRUE(std::all_of(line.begin(), line.end() - 1, [](unsigned char c) {
    return c >= 0x20 && c < 0x7F;
  })) << line;
  EXPECT_NE(line.find(R"("name":"x\"}\\n{\"time\")"), std::string::npos) << line;
  EXPECT_NE(line.find(R"("verb":"200","argument":null)"), std::string::npos) << line;
}

TEST(AuditLog, AppendsToWhatIsThere) {
  const AuditFolder folder;
  for (int n = 0; n < 2; ++n) {
    AuditLog log({.file = folder.file()});
    EXPECT_TRUE(while_written(log, [&] {
                  for (std::uint64_t i = 0; i < 100; ++i) log.append(hold_of(i));
                }).empty());
    EXPECT_EQ(log.lost(), 0U);
  }
  EXPECT_EQ(lines_of(test::read_text(folder.file())), 200U);
  struct stat facts {};
  ASSERT_EQ(::stat(folder.file().c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0137U, 0U) << "written or read by others";
}

TEST(AuditLog, EndsALineThatWasTornByAKill) {
  const AuditFolder folder;
  std::ofstream(folder.file()) << R"({"time":"2026-)";
  AuditLog log({.file = folder.file()});
  (void)while_written(log, [&] { log.append(hold_of(1)); });
  EXPECT_EQ(test::read_text(folder.file()), "{\"time\":\"2026-\n" + to_line(hold_of(1)));
}

TEST(AuditLog, PutsFilesAsideBySizeAndKeepsSoMany) {
  const AuditFolder folder;
  const std::uint64_t line_bytes = to_line(hold_of(10)).size();
  AuditLog log({.file = folder.file(), .file_bytes = 10 * line_bytes, .files = 3});
  (void)while_written(log, [&] {
    for (std::uint64_t i = 10; i < 75; ++i) log.append(hold_of(i));
  });
  EXPECT_EQ(lines_of(test::read_text(folder.file())), 5U);
  for (const char* ending : {".1", ".2", ".3"}) {
    EXPECT_EQ(lines_of(test::read_text(folder.file().string() + ending)), 10U) << ending;
  }
  EXPECT_FALSE(fs::exists(folder.file().string() + ".4"));
  const std::string newest = test::read_text(folder.file());
  EXPECT_NE(newest.find("\"request\":74"), std::string::npos) << newest;
}

TEST(AuditLog, CountsWhatFoundNoRoomAndSaysSoInALine) {
  const AuditFolder folder;
  AuditLog log({.file = folder.file()});
  constexpr std::uint64_t kMore = 17;
  for (std::uint64_t i = 0; i < AuditLog::kQueued + kMore; ++i) log.append(hold_of(i));
  EXPECT_EQ(log.lost(), kMore) << "nobody writes yet";
  (void)while_written(log, [] {});
  const std::string text = test::read_text(folder.file());
  EXPECT_EQ(lines_of(text), AuditLog::kQueued + 1);
  EXPECT_NE(text.find("\"event\":\"lost\",\"lines\":17,"), std::string::npos);
}

TEST(AuditLog, TakesFromManyThreadsWhatEachOfThemSays) {
  const AuditFolder folder;
  AuditLog log({.file = folder.file()});
  constexpr std::uint64_t kEach = 5000;
  (void)while_written(log, [&] {
    std::vector<std::thread> threads;
    for (std::uint64_t t = 0; t < 3; ++t) {
      threads.emplace_back([&log, t] {
        for (std::uint64_t i = 0; i < kEach; ++i) log.append(hold_of(t * kEach + i + 1));
      });
    }
    for (std::thread& thread : threads) thread.join();
  });
  const std::string text = test::read_text(folder.file());
  std::size_t commands = 0;
  for (std::size_t at = 0; (at = text.find("\"event\":\"command\"", at)) != std::string::npos;
       ++at) {
    ++commands;
  }
  EXPECT_EQ(commands + log.lost(), 3 * kEach);
}

TEST(AuditLog, OnAFullDiskComplainsOnceAndSaysLaterWhatIsMissing) {
  const AuditFolder folder;
  AuditLog log({.file = folder.file()});
  const auto before = ::signal(SIGXFSZ, SIG_IGN);
  rlimit free{}, full{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &free), 0);
  full = free;
  full.rlim_cur = 300;  // a line and a half
  const auto complaints = while_written(log, [&] {
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &full), 0);
    for (std::uint64_t i = 0; i < 4; ++i) log.append(hold_of(i));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &free), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    log.append(hold_of(99));
  });
  (void)::signal(SIGXFSZ, before);
  ASSERT_EQ(complaints.size(), 1U);
  EXPECT_NE(complaints[0].find("cannot be written"), std::string::npos) << complaints[0];
  const std::string text = test::read_text(folder.file());
  EXPECT_NE(text.find("\"event\":\"lost\",\"lines\":3,"), std::string::npos) << text;
  EXPECT_NE(text.find("\"request\":99"), std::string::npos) << text;
}

TEST(AuditLog, RefusesALinkAndWhatIsNoFile) {
  const AuditFolder folder;
  const auto refusal = [&] {
    try {
      const AuditLog log({.file = folder.file()});
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  const fs::path other = folder.file().string() + ".other";
  std::ofstream(other) << "not ours";
  fs::create_symlink(other, folder.file());
  EXPECT_NE(refusal().find("lai.audit.log is a symbolic link"), std::string::npos) << refusal();
  EXPECT_EQ(test::read_text(other), "not ours");
  fs::remove(folder.file());
  ASSERT_EQ(::mkfifo(folder.file().c_str(), 0600), 0);
  EXPECT_NE(refusal().find("is no regular file"), std::string::npos) << refusal();
  fs::remove(folder.file());
  fs::create_directory(folder.file());
  EXPECT_NE(refusal().find("is no regular file"), std::string::npos) << refusal();
}

TEST(AuditLog, IsKeptByNobodyWhereNoFileIsNamed) {
  AuditLog log({});
  EXPECT_FALSE(log.is_kept());
  (void)while_written(log, [&] { log.append(hold_of(1)); });
}

}  // namespace
}  // namespace meridian::telemetry
