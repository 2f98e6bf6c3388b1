// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/journal/journal.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "support/text_file.hpp"

namespace meridian::telemetry {
namespace {

namespace fs = std::filesystem;

JournalEntry sample_entry() {
  JournalEntry entry;
  entry.time_ns = 1'790'000'000'123'456'789;
  entry.session = 0xFEDCBA9876543210U;
  entry.block = 4710;
  entry.line = 4720;
  entry.reached = Reached::kDone;
  entry.state = State::kHeld;
  entry.count = 77;
  entry.from_line = 4711;
  entry.next_line = 4720;
  entry.file_checksum = 0x8000000000000001U;
  entry.setup = {1, 2, 3, 98.5};
  put_text("cam\none", entry.station);
  put_text("blade = 7.apt", entry.program);
  put_text("--units inch", entry.options);
  put_text("drive b3 reports a fault", entry.alarm);
  put_text("door.apt, cut up to line 12", entry.dropped);
  return entry;
}

/// A folder of its own, gone with this object.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("meridian-journal-" + std::to_string(::getpid()))) {
    fs::remove_all(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// What `body` finds in a journal whose thread runs beside it.
template <class Body>
std::vector<std::string> run_beside(Journal& journal, Body body) {
  std::vector<std::string> complaints;
  std::thread writer(
      [&] { journal.run([&](const std::string& text) { complaints.push_back(text); }); });
  body();
  journal.stop();
  writer.join();
  return complaints;
}

TEST(JournalEntry, ComesBackFromItsText) {
  const JournalEntry written = sample_entry();
  const auto read = parse_journal(to_text(written, "lai"), "lai");
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(read->time_ns, written.time_ns);
  EXPECT_EQ(read->session, written.session);
  EXPECT_EQ(read->block, written.block);
  EXPECT_EQ(read->line, written.line);
  EXPECT_EQ(read->reached, written.reached);
  EXPECT_EQ(read->state, written.state);
  EXPECT_EQ(read->count, written.count);
  EXPECT_EQ(read->from_line, written.from_line);
  EXPECT_EQ(read->next_line, written.next_line);
  EXPECT_EQ(read->file_checksum, written.file_checksum);
  EXPECT_EQ(read->setup.frame, 1U);
  EXPECT_EQ(read->setup.machine, 2U);
  EXPECT_EQ(read->setup.tools, 3U);
  EXPECT_EQ(read->setup.tool_mm, 98.5);
  EXPECT_STREQ(read->dropped.data(), "door.apt, cut up to line 12");
  EXPECT_STREQ(read->station.data(), "cam one") << "a text never breaks a line";
  EXPECT_STREQ(read->program.data(), "blade = 7.apt");
  EXPECT_STREQ(read->options.data(), "--units inch");
  EXPECT_STREQ(read->alarm.data(), "drive b3 reports a fault");
}

TEST(JournalEntry, ThatIsTornAnywhereIsRefused) {
  const std::string whole = to_text(sample_entry(), "lai");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(parse_journal(std::string_view(whole).substr(0, size), "lai")) << size;
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 4);
    EXPECT_FALSE(parse_journal(changed, "lai")) << at;
  }
  EXPECT_FALSE(parse_journal(whole + "x", "lai"));
}

TEST(JournalEntry, OfSomebodyElseIsRefusedWithTheReason) {
  const auto why = [](const std::string& text) {
    const auto read = parse_journal(text, "lai");
    return read ? std::string("taken") : read.error();
  };
  EXPECT_EQ(why("cycle,due_ns,line\n"), "is no journal of this service");
  EXPECT_EQ(why("meridian journal 9\nmachine = lai\n"), "is of another version of this service");
  EXPECT_EQ(why(to_text(sample_entry(), "bench")), "is of machine 'bench', not of 'lai'");
  EXPECT_EQ(why("meridian journal 2\nmachine = lai\n"), "is torn: its end is missing");
}

TEST(JournalEntry, NamesTheFirstLineThatIsNotFinished) {
  JournalEntry entry = sample_entry();
  const auto expect = [&entry](const std::string& words) {
    EXPECT_EQ(describe(entry), "last program: blade = 7.apt, " + words);
  };
  expect("line 4720 done up to block 4710; go on with --from-line 4720");
  entry.reached = Reached::kBegun;
  expect("line 4720 begun; go on with --from-line 4720");
  entry.state = State::kRunning;
  expect("line 4720 begun at least; go on with --from-line 4720");
  entry.reached = Reached::kLineDone;
  entry.next_line = 4721;
  expect("line 4720 done; go on with --from-line 4721");
  entry.reached = Reached::kBegun;
  entry.next_line = 4720;
  entry.state = State::kFault;
  expect(
      "line 4720 at the alarm, what was cut may end earlier (flight record); go on with "
      "--from-line 4720 at the latest");
  entry.line = 2;
  entry.from_line = entry.next_line = 4711;
  expect(
      "cut up to line 4711; begun again from line 4711, it had not come to the cut; go on with "
      "--from-line 4711 at the latest");
  entry.state = State::kApproaching;
  expect(
      "cut up to line 4711; begun again from line 4711, it had not come to the cut; go on with "
      "--from-line 4711");
  entry.from_line = 4000;
  entry.line = 4100;
  expect(
      "cut up to line 4711; begun again from line 4000, it came to line 4100; go on with "
      "--from-line 4711, or 4100 for what was begun again");
  entry.next_line = 0;
  expect("not begun; stream it from its begin");
  entry.reached = Reached::kEnd;
  expect("ran to its end");
  const std::string more = describe_more(sample_entry());
  for (const char* part : {"2026-09-21", "UTC", "Held", "cam one", "--units inch", "drive b3"}) {
    EXPECT_NE(more.find(part), std::string::npos) << more;
  }
}

TEST(Journal, GivesTheNextServiceTheLastEntry) {
  const Folder folder;
  {
    Journal journal(folder.path() / "made", "lai");
    EXPECT_EQ(journal.complaint(), "");
    EXPECT_FALSE(journal.read()) << "there was no service before";
    EXPECT_EQ(journal.complaint(), "");
    const auto complaints = run_beside(journal, [&] {
      JournalEntry entry = sample_entry();
      for (entry.line = 1; entry.line <= 50; ++entry.line) journal.take(entry);
    });
    EXPECT_TRUE(complaints.empty());
  }
  Journal next(folder.path() / "made", "lai");
  const auto entry = next.read();
  ASSERT_TRUE(entry) << next.complaint();
  EXPECT_EQ(entry->line, 50U);
  EXPECT_FALSE(fs::exists(next.path().string() + ".new"));
}

TEST(JournalPosition, IsNewerThanItsEntryWholeAndOfItsSessionOrNothing) {
  const JournalEntry entry = sample_entry();
  JournalEntry newer = entry;
  ++newer.count;
  newer.line = 4800;
  newer.next_line = 4801;
  newer.reached = Reached::kLineDone;
  newer.state = State::kRunning;
  const std::string text = to_position(newer);
  ASSERT_EQ(text.size(), kPositionBytes);
  JournalEntry read = entry;
  read_position(text, read);
  EXPECT_EQ(to_text(read, "lai"), to_text(newer, "lai"));
  for (std::size_t at = 0; at < text.size(); ++at) {
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 4);
    read = entry;
    read_position(changed, read);
    EXPECT_EQ(read.line, entry.line) << at;
  }
  JournalEntry other = entry;
  other.session = 1;
  read_position(text, other);
  EXPECT_EQ(other.line, entry.line);
  read = newer;
  read.line = 4900;
  read_position(text, read);
  EXPECT_EQ(read.line, 4900U) << "no newer than what is known";
}

TEST(Journal, OfAServiceThatWasKilledIsBroughtUpToDateByItsNewestPosition) {
  const Folder folder;
  JournalEntry entry = sample_entry();
  {
    Journal journal(folder.path(), "lai");
    (void)run_beside(journal, [&] {
      journal.take(entry);
      for (int n = 0; n < 5; ++n) {
        ++entry.count;
        ++entry.line;
        journal.take_position(entry);
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
      }
    });
  }
  Journal next(folder.path(), "lai");
  const auto read = next.read();
  ASSERT_TRUE(read) << next.complaint();
  EXPECT_EQ(read->line, entry.line);
  EXPECT_STREQ(read->program.data(), "blade = 7.apt");
}

TEST(Journal, WritesNoPositionThroughALink) {
  const Folder folder;
  fs::create_directories(folder.path());
  std::ofstream(folder.path() / "other") << "not ours";
  fs::create_symlink("other", folder.path() / "lai.position");
  Journal journal(folder.path(), "lai");
  (void)run_beside(journal, [&] { journal.take_position(sample_entry()); });
  EXPECT_EQ(test::read_text(folder.path() / "other"), "not ours");
}

TEST(Journal, PutsAsideWhatIsTornAndGoesOn) {
  const Folder folder;
  fs::create_directories(folder.path());
  Journal journal(folder.path(), "lai");
  const std::string whole = to_text(sample_entry(), "lai");
  std::ofstream(journal.path()) << whole.substr(0, whole.size() / 2);
  EXPECT_FALSE(journal.read());
  EXPECT_NE(journal.complaint().find("torn"), std::string::npos) << journal.complaint();
  EXPECT_NE(journal.complaint().find("lai.journal.refused"), std::string::npos);
  EXPECT_EQ(test::read_text(journal.path().string() + ".refused"),
            whole.substr(0, whole.size() / 2));
  (void)run_beside(journal, [&] { journal.take(sample_entry()); });
  EXPECT_EQ(test::read_text(journal.path()), whole);
}

TEST(Journal, PutsAsideWhatIsThereAndCannotBeReadAsAFile) {
  const Folder folder;
  const std::string whole = to_text(sample_entry(), "lai");
  const auto expect_aside = [&](const char* what, const std::string& why, const auto& make) {
    fs::remove_all(folder.path());
    fs::create_directories(folder.path());
    Journal journal(folder.path(), "lai");
    make(journal.path());
    EXPECT_FALSE(journal.read()) << what;
    EXPECT_NE(journal.complaint().find(why), std::string::npos)
        << what << ": " << journal.complaint();
    EXPECT_FALSE(fs::exists(fs::symlink_status(journal.path()))) << what << " would be replaced";
    EXPECT_TRUE(fs::exists(fs::symlink_status(journal.path().string() + ".refused"))) << what;
  };
  expect_aside("a link", "symbolic link", [&](const fs::path& path) {
    std::ofstream(folder.path() / "elsewhere") << whole;
    fs::create_symlink("elsewhere", path);
  });
  expect_aside("a folder", "is no regular file",
               [](const fs::path& path) { fs::create_directory(path); });
  expect_aside("a pipe that nobody writes", "is no regular file",
               [](const fs::path& path) { ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0); });
  if (::geteuid() == 0) return;  // who may read everything
  expect_aside("somebody else's", "Permission denied", [&](const fs::path& path) {
    std::ofstream(path) << whole;
    fs::permissions(path, fs::perms::none);
  });
}

TEST(Journal, OfAServiceKilledWhileItWroteIsTheOneBefore) {
  const Folder folder;
  fs::create_directories(folder.path());
  Journal journal(folder.path(), "lai");
  const std::string whole = to_text(sample_entry(), "lai");
  ASSERT_EQ(replace_file(journal.path(), whole), 0);
  std::ofstream(journal.path().string() + ".new") << whole.substr(0, 40);
  EXPECT_TRUE(journal.read()) << journal.complaint();
}

TEST(Journal, IsNotWrittenThroughALinkThatLiesInItsWay) {
  const Folder folder;
  fs::create_directories(folder.path());
  const fs::path path = folder.path() / "lai.journal", other = folder.path() / "other";
  std::ofstream(other) << "not ours";
  fs::create_symlink(other, path.string() + ".new");
  ASSERT_EQ(replace_file(path, "text"), 0);
  EXPECT_EQ(test::read_text(other), "not ours");
  EXPECT_EQ(test::read_text(path), "text");
  EXPECT_FALSE(fs::is_symlink(path));
}

TEST(Journal, IsReadByItsOwnerAndTheirGroupAlone) {
  const Folder folder;
  fs::create_directories(folder.path());
  const fs::path path = folder.path() / "lai.journal";
  const mode_t umask_before = ::umask(0);
  EXPECT_EQ(replace_file(path, "text"), 0);
  (void)::umask(umask_before);
  EXPECT_EQ(fs::status(path).permissions(), static_cast<fs::perms>(0640));
}

TEST(Journal, OnABlockedDiskHindersNobodyAndGetsTheNewestAfterwards) {
  const Folder folder;
  std::promise<void> disk;
  std::shared_future<void> disk_is_free = disk.get_future().share();
  std::vector<std::string> written;
  std::atomic<bool> is_writing{false};
  Journal journal(folder.path(), "lai", [&](const fs::path&, const std::string& text) {
    is_writing = true;
    disk_is_free.wait();
    written.push_back(text);
    return 0;
  });
  (void)run_beside(journal, [&] {
    JournalEntry entry = sample_entry();
    journal.take(entry);
    while (!is_writing) std::this_thread::yield();
    const auto begin = std::chrono::steady_clock::now();
    for (entry.line = 0; entry.line <= 1000; ++entry.line) journal.take(entry);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(500));
    disk.set_value();
  });
  ASSERT_EQ(written.size(), 2U);
  EXPECT_NE(written[1].find("line = 1000\n"), std::string::npos) << written[1];
}

TEST(Journal, OnAFullDiskComplainsOnce) {
  const Folder folder;
  std::atomic<int> writes{0};
  Journal journal(folder.path(), "lai", [&](const fs::path&, const std::string&) {
    ++writes;
    return ENOSPC;
  });
  const auto complaints = run_beside(journal, [&] {
    for (int n = 1; n <= 3; ++n) {
      journal.take(sample_entry());
      while (writes < n) std::this_thread::yield();
    }
  });
  ASSERT_EQ(complaints.size(), 1U);
  EXPECT_NE(complaints[0].find("No space left"), std::string::npos) << complaints[0];
}

}  // namespace
}  // namespace meridian::telemetry
