// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>

#include "integration/live_run.hpp"
#include "integration/plant.hpp"
#include "service/text/alike_lines.hpp"

namespace meridian::test {
namespace {

/// A pipe in place of a program's log, full, that nobody reads.
class FullPipe {
 public:
  explicit FullPipe(std::filesystem::path path) : path_(std::move(path)) {
    EXPECT_EQ(::mkfifo(path_.c_str(), 0600), 0);
    file_ = ::open(path_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    const std::string line(99, '.');
    for (std::size_t size : {std::size_t{100}, std::size_t{1}}) {
      while (::write(file_, (line + "\n").data(), size) > 0) continue;
    }
  }
  /// Gone, so that nobody who looks into the log waits for it.
  ~FullPipe() {
    ::close(file_);
    std::filesystem::remove(path_);
  }
  FullPipe(const FullPipe&) = delete;
  FullPipe& operator=(const FullPipe&) = delete;

  /// What is in it, which it has room for again.
  [[nodiscard]] std::string take() const {
    std::string text;
    std::array<char, 4096> bytes;
    for (ssize_t n = 0; (n = ::read(file_, bytes.data(), bytes.size())) > 0;) {
      text.append(bytes.data(), static_cast<std::size_t>(n));
    }
    return text;
  }

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

TEST(BlockedLog, HoldsUpNoStopNoMessageAndNotTheEndOfTheService) {
  Plant plant;
  const FullPipe service_log(plant.folder() / "service.log");
  plant.start_service({"--service", service_file(plant)});
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.standing();
  const Process flood(
      {"attacker", "flood", "--domain", plant.domain(), "--machine", "lai", "--topics",
       "cl_batch,action_done,drive_command", "--shape", "foreign", "--rate", "2000", "--for", "60"},
      plant.folder() / "flood.log");
  ASSERT_TRUE(plant.stream(small_program(400, 1500, 0.5), [](const stream::Station& station) {
    return station.state() == stream::StationState::kComplete;
  })) << plant.station().message();
  ASSERT_TRUE(plant.runs_until([](const auto& s) { return s.state == State::kLoaded; }))
      << plant.standing();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  ASSERT_TRUE(plant.runs_until([](const auto& s) { return s.blocks_done > 3; }))
      << plant.standing();
  std::this_thread::sleep_for(milliseconds(1500));  // thousands of lines
  const auto asked = std::chrono::steady_clock::now();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kHold));
  EXPECT_LT(std::chrono::steady_clock::now() - asked, milliseconds(500)) << "answered late";
  ASSERT_TRUE(plant.wait_for(State::kHeld)) << plant.standing();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kAbort));
  ASSERT_TRUE(plant.wait_for(State::kReady)) << plant.standing();

  // The first lines of a kind may be gone by now. Their count comes when the while of that kind is
  // over; a line of another kind may come sooner, as the identities in them are drawn.
  constexpr auto kCounted = std::chrono::nanoseconds(text::AlikeLines::kWhile_ns);
  (void)service_log.take();
  std::string said;
  EXPECT_TRUE(eventually(
      [&] {
        said += service_log.take();
        return said.find("DDS: ") != std::string::npos;
      },
      std::chrono::duration_cast<milliseconds>(kCounted) + milliseconds(5000)))
      << said;
  plant.service().send_signal(SIGTERM);
  EXPECT_EQ(plant.service().wait(milliseconds(5000)), 0);
}

TEST(BlockedLog, IsNotWaitedForAtTheEnd) {
  Plant plant;
  const FullPipe service_log(plant.folder() / "service.log");
  plant.start_service({"--service", service_file(plant)});
  ASSERT_TRUE(eventually([&] { return plant.status().state == State::kOff; }));
  plant.service().send_signal(SIGTERM);
  EXPECT_EQ(plant.service().wait(milliseconds(4000)), 0);
}

TEST(BlockedLog, HoldsUpNoDrivesFromTheirBeginToTheirEnd) {
  Plant plant;
  const FullPipe drives_log(plant.folder() / "drives.log");
  plant.start_service({"--service", service_file(plant)});
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.standing();
  plant.drives().send_signal(SIGTERM);
  EXPECT_EQ(plant.drives().wait(milliseconds(4000)), 0);
}

TEST(BlockedLog, KeepsNoWatcherAlive) {
  Plant plant;
  const FullPipe watched(plant.folder() / "watch.log");
  plant.start_service({"--service", service_file(plant)});
  ASSERT_TRUE(eventually([&] { return plant.status().state == State::kOff; }));
  Process watcher({"meridian", "status", "--watch", "--domain", plant.domain()},
                  plant.folder() / "watch.log");
  std::this_thread::sleep_for(milliseconds(3000));
  watcher.send_signal(SIGTERM);
  EXPECT_EQ(watcher.wait(milliseconds(4000)), 0);
}

}  // namespace
}  // namespace meridian::test
