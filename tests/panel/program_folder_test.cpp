// SPDX-License-Identifier: Apache-2.0
#include "service/panel/desks/program_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace meridian::panel {
namespace {

namespace fs = std::filesystem;

/// Gives `text` in pieces of 7 bytes.
[[nodiscard]] ProgramFolder::ReadBytes pieces_of(const std::string& text) {
  return [text, at = std::size_t{0}](char* buffer, std::size_t size) mutable -> std::int64_t {
    const std::size_t count = std::min({size, std::size_t{7}, text.size() - at});
    text.copy(buffer, count, at);
    at += count;
    return static_cast<std::int64_t>(count);
  };
}

[[nodiscard]] std::string content_of(const std::string& file) {
  std::ostringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

TEST(ProgramFolder, KeepsTheProgramAsItCame) {
  ProgramFolder folder;
  const std::string text = "PARTNO/ONE\r\nFINI\n";
  const auto program = folder.receive("part.apt", text.size(), pieces_of(text));
  ASSERT_TRUE(program) << program.error();
  folder.adopt(*program);
  EXPECT_EQ(content_of(folder.file()), text);
  EXPECT_EQ(fs::path(folder.file()).filename(), "part.apt");
  EXPECT_EQ(folder.read_lines(*program, 1, 10), "PARTNO/ONE\nFINI\n");
}

TEST(ProgramFolder, NamesLeadNowhereElse) {
  EXPECT_EQ(ProgramFolder::plain_name("../../etc/passwd"), "passwd");
  EXPECT_EQ(ProgramFolder::plain_name("C:\\nc\\part 1.nc"), "part_1.nc");
  EXPECT_EQ(ProgramFolder::plain_name(".."), "program");
  EXPECT_EQ(ProgramFolder::plain_name(".profile"), "profile");
  EXPECT_EQ(ProgramFolder::plain_name(std::string("a\0b", 3)), "a_b");
  EXPECT_EQ(ProgramFolder::plain_name(std::string(300, 'x') + ".apt").size(), 80U);
}

TEST(ProgramFolder, TheNextProgramTakesThePlaceOfTheLast) {
  ProgramFolder folder;
  for (const char* const name : {"one.apt", "two.apt"}) {
    const auto program = folder.receive(name, 4, pieces_of("FINI"));
    ASSERT_TRUE(program);
    folder.adopt(*program);
  }
  const fs::path where = fs::path(folder.file()).parent_path();
  EXPECT_EQ(std::distance(fs::directory_iterator(where), fs::directory_iterator()), 1);
}

TEST(ProgramFolder, RefusesWhatIsTooLongEmptyOrCutShort) {
  const ProgramFolder folder;
  EXPECT_FALSE(folder.receive("a", ProgramFolder::kMaxBytes + 1, pieces_of("x")));
  EXPECT_FALSE(folder.receive("a", 0, pieces_of("")));
  EXPECT_FALSE(folder.receive("a", 100, pieces_of("too short")));
  EXPECT_EQ(folder.file(), "");
}

TEST(ProgramFolder, LinesAreFoundAnywhereInALongProgram) {
  std::string text;
  for (int i = 1; i <= 5000; ++i) text += "line " + std::to_string(i) + "\n";
  ProgramFolder folder;
  const auto program = folder.receive("long.apt", text.size(), pieces_of(text));
  ASSERT_TRUE(program);
  folder.adopt(*program);
  EXPECT_EQ(program->lines, 5001U);
  for (const std::uint64_t line : {1U, 255U, 256U, 257U, 512U, 513U, 4999U}) {
    EXPECT_EQ(folder.read_lines(*program, line, 1), "line " + std::to_string(line) + "\n");
  }
  EXPECT_EQ(folder.read_lines(*program, 6000, 1), "");
  EXPECT_EQ(folder.read_lines(*program, 0, 1), "");
}

TEST(ProgramFolder, GoesWithThePanel) {
  std::string file;
  {
    ProgramFolder folder;
    const auto program = folder.receive("a.apt", 4, pieces_of("FINI"));
    ASSERT_TRUE(program);
    folder.adopt(*program);
    file = folder.file();
    EXPECT_TRUE(fs::exists(file));
  }
  EXPECT_FALSE(fs::exists(fs::path(file).parent_path()));
}

}  // namespace
}  // namespace meridian::panel
