// SPDX-License-Identifier: Apache-2.0
#include "service/text/whole_file.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "service/host/process/programs.hpp"

namespace meridian::text {
namespace {

namespace fs = std::filesystem;

class WrittenFile : public testing::Test {
 protected:
  [[nodiscard]] static std::string read(const fs::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  process::ScratchFolder folder_;
  fs::path file_ = folder_.path() / "file", other_ = folder_.path() / "other";
  fs::path nowhere_ = folder_.path() / "no" / "such" / "folder";
};

TEST_F(WrittenFile, IsReplacedInOneStep) {
  ASSERT_TRUE(write_whole(file_, "old"));
  ASSERT_TRUE(write_whole(file_, "new"));
  EXPECT_EQ(read(file_), "new");
  EXPECT_FALSE(fs::exists(file_.string() + ".part"));
  EXPECT_FALSE(write_whole(nowhere_, "x"));
}

TEST_F(WrittenFile, IsReadByteForByte) {
  const std::string content("two\r\nlines\0and a zero\n", 22);
  ASSERT_TRUE(write_whole(file_, content));
  EXPECT_EQ(read_whole(file_), content);
  ASSERT_TRUE(write_whole(other_, ""));
  EXPECT_EQ(read_whole(other_), "");
  EXPECT_FALSE(read_whole(nowhere_ / "file"));
}

TEST_F(WrittenFile, IsANewOneWhateverLiesThere) {
  for (const Sync sync : {Sync::kLater, Sync::kNow}) {
    std::ofstream(other_) << "not ours";
    fs::remove(file_);
    fs::create_symlink(other_, file_);
    ASSERT_EQ(write_anew(file_, "ours", sync), 0);
    EXPECT_EQ(read(file_), "ours");
    EXPECT_EQ(read(other_), "not ours");
    EXPECT_FALSE(fs::is_symlink(file_));
    ASSERT_EQ(write_anew(file_, "again", sync), 0);
    EXPECT_EQ(read(file_), "again");
  }
}

TEST_F(WrittenFile, IsNotThereWhereItCouldNotBeWrittenAndTheReasonIsReported) {
  EXPECT_EQ(write_anew(nowhere_, "x"), ENOENT);
  fs::create_directory(file_);
  EXPECT_EQ(write_anew(file_, "x"), EEXIST);
}

TEST_F(WrittenFile, IsNeitherReadNorWrittenASecondTimeByTheSameRun) {
  const std::string there = file_, none = other_;
  ASSERT_TRUE(write_whole(there, "x"));
  fs::create_symlink(file_, folder_.path() / "link");
  const std::string link = folder_.path() / "link", roundabout = folder_.path() / "." / "other";
  EXPECT_EQ(refusal_to_write({there, ""}, {none, "", ""}), "");
  EXPECT_EQ(refusal_to_write({there}, {none, link}).find(link + ": is read by this run"), 0U);
  for (const auto& [one, same] : {std::pair(there, link), std::pair(none, roundabout)}) {
    EXPECT_EQ(refusal_to_write({}, {one, same}).find(same + ": is written twice"), 0U) << same;
  }
  EXPECT_EQ(refusal_to_write({}, {"/dev/null", "/dev/null"}), "");
}

}  // namespace
}  // namespace meridian::text
