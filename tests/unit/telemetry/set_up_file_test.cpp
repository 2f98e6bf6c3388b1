// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/journal/set_up_file.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace meridian::telemetry {
namespace {

namespace fs = std::filesystem;
using Progress = SetUpFile::Progress;

class SetUpFileOfAFolder : public ::testing::Test {
 protected:
  SetUpFileOfAFolder()
      : folder_(fs::temp_directory_path() / ("meridian-set-up-" + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~SetUpFileOfAFolder() override { fs::remove_all(folder_); }

  static telemetry::SetUp frames_with(int number, double x_mm) {
    FrameOrder order;
    order.frame.number = static_cast<std::uint8_t>(number);
    order.frame.origin_mm = {x_mm, 2, 3};
    WorkFrames frames;
    EXPECT_EQ(frames.apply(order), FrameFault::kNone);
    return {frames, "# " + std::to_string(x_mm)};
  }

  [[nodiscard]] Expected<telemetry::SetUp, std::string> read_again() const {
    return SetUpFile(folder_, "lai").read();
  }

  fs::path folder_;
};

TEST_F(SetUpFileOfAFolder, HoldsNothingBeforeTheFirstWord) {
  const auto frames = read_again();
  ASSERT_TRUE(frames) << frames.error();
  EXPECT_EQ(*frames, telemetry::SetUp());
}

TEST_F(SetUpFileOfAFolder, IsNotKeptWithoutAFolder) {
  EXPECT_FALSE(SetUpFile("", "lai").is_kept());
  EXPECT_TRUE(SetUpFile("", "lai").read());
}

TEST_F(SetUpFileOfAFolder, IsWrittenBeforeItIsReportedAsWritten) {
  SetUpFile file(folder_, "lai");
  EXPECT_EQ(file.look(), Progress::kNone);
  file.ask(frames_with(3, 1.5));
  EXPECT_EQ(file.look(), Progress::kAsked);
  EXPECT_EQ(*read_again(), telemetry::SetUp());
  file.work();
  EXPECT_EQ(*read_again(), frames_with(3, 1.5));
  EXPECT_EQ(file.look(), Progress::kWritten);
  EXPECT_EQ(file.look(), Progress::kNone);  // reported once
}

TEST_F(SetUpFileOfAFolder, StaysTheOldOneWhereTheNewOneCannotBeWritten) {
  int error = 0;
  SetUpFile file(folder_, "lai", [&error](const fs::path& path, const std::string& text) {
    // The folder's sync fails: the new file is in place by then.
    return replace_file(path, text) != 0 ? EIO : error;
  });
  file.ask(frames_with(1, 1));
  file.work();
  ASSERT_EQ(file.look(), Progress::kWritten);
  error = ENOSPC;
  file.ask(frames_with(1, 2));
  file.work();
  EXPECT_EQ(file.look(), Progress::kFailed);
  EXPECT_EQ(file.error(), ENOSPC);
  EXPECT_EQ(*read_again(), frames_with(1, 1));
}

TEST_F(SetUpFileOfAFolder, IsTheOldOneOrTheNewOneWheneverItsWriterIsKilled) {
  constexpr int kKills = 60;
  std::mt19937 engine(20261125);
  double min = 0;
  for (int n = 0; n < kKills; ++n) {
    std::array<int, 2> written{};
    ASSERT_EQ(::pipe(written.data()), 0);
    const pid_t writer = ::fork();
    if (writer == 0) {
      SetUpFile file(folder_, "lai");
      for (double x_mm = min + 1;; ++x_mm) {
        file.ask(frames_with(1 + static_cast<int>(x_mm) % 9, x_mm));
        file.work();
        if (file.look() != Progress::kWritten) ::_exit(1);
        if (::write(written[1], &x_mm, sizeof x_mm) != sizeof x_mm) ::_exit(1);
      }
    }
    (void)::usleep(std::uniform_int_distribution<unsigned>(0, 20'000)(engine));
    ASSERT_EQ(::kill(writer, SIGKILL), 0);
    ASSERT_EQ(::waitpid(writer, nullptr, 0), writer);
    (void)::close(written[1]);
    double acknowledged = min;
    for (double x_mm = 0; ::read(written[0], &x_mm, sizeof x_mm) == sizeof x_mm;)
      acknowledged = x_mm;
    (void)::close(written[0]);
    const auto frames = read_again();
    ASSERT_TRUE(frames) << frames.error();
    const double left =
        frames->frames.rows().empty() ? 0 : frames->frames.rows().front().origin_mm[0];
    if (left > 0) {
      EXPECT_EQ(*frames, frames_with(1 + static_cast<int>(left) % 9, left));
    }
    EXPECT_GE(left, acknowledged);
    EXPECT_LE(left, acknowledged + 1);
    min = left;
  }
  EXPECT_GT(min, 0);
}

TEST_F(SetUpFileOfAFolder, RefusesWhatIsNoSetUp) {
  std::ofstream(folder_ / "lai.setup") << "meridian set-up 1\nmachine = lai\n";
  const auto torn = read_again();
  ASSERT_FALSE(torn);
  EXPECT_EQ(torn.error(), "is torn: its end is missing");
  fs::remove(folder_ / "lai.setup");
  fs::create_symlink("elsewhere", folder_ / "lai.setup");
  EXPECT_EQ(read_again().error(), "is a symbolic link");
}

}  // namespace
}  // namespace meridian::telemetry
