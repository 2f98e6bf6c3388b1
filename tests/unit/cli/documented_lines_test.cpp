// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/command_output.hpp"

/// The command lines of README and docs against what the programs take.
namespace {

namespace fs = std::filesystem;

struct Line {
  std::string where;
  std::vector<std::string> words;
};

/// Words of `text` up to a comment, a pipe or the end of the command.
std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) {
    if (word.front() == '#' || word == "&" || word == "|" || word == "&&" || word.front() == '>') {
      break;
    }
    words.push_back(word);
  }
  return words;
}

/// Every line of a fenced block that calls meridian or meridiand, continuation lines joined.
void collect(const fs::path& page, std::vector<Line>& lines) {
  std::ifstream in(page);
  bool is_inside = false;
  std::string text, command;
  for (int number = 1; std::getline(in, text); ++number) {
    if (text.rfind("```", 0) == 0) is_inside = !is_inside;
    if (!is_inside) continue;
    const bool goes_on = !text.empty() && text.back() == '\\';
    command += goes_on ? text.substr(0, text.size() - 1) : text;
    if (goes_on) continue;
    std::vector<std::string> words = words_of(command);
    command.clear();
    const std::string name = words.empty() ? "" : fs::path(words[0]).filename().string();
    if (name != "meridian" && name != "meridiand") continue;
    words[0] = name;
    lines.push_back({page.filename().string() + ":" + std::to_string(number), words});
  }
}

std::string help_of(const std::string& command) {
  static std::map<std::string, std::string> known;
  if (const auto found = known.find(command); found != known.end()) return found->second;
  std::string& text = known[command];
  const auto run =
      meridian::test::run_command(MERIDIAN_BINARY_DIR "/bin/" + command + " --help 2>&1");
  if (run.exit_code == 0) text = run.output;
  return text;
}

bool names(const std::string& help, const std::string& option) {
  for (std::size_t at = help.find(option); at != std::string::npos;
       at = help.find(option, at + 1)) {
    const char next = at + option.size() < help.size() ? help[at + option.size()] : ' ';
    if (std::string(" ,:\n").find(next) != std::string::npos) return true;
  }
  return false;
}

TEST(DocumentedLines, CallSubcommandsAndOptionsThatExist) {
  std::vector<Line> lines;
  collect(fs::path(MERIDIAN_SOURCE_DIR) / "README.md", lines);
  for (const auto& page : fs::directory_iterator(fs::path(MERIDIAN_SOURCE_DIR) / "docs")) {
    if (page.path().extension() == ".md") collect(page.path(), lines);
  }
  EXPECT_GT(lines.size(), 20U) << "are the fenced blocks still found?";
  for (const Line& line : lines) {
    SCOPED_TRACE(line.where);
    const bool is_tool = line.words[0] == "meridian";
    ASSERT_TRUE(!is_tool || line.words.size() > 1);
    const bool has_subcommand = is_tool && line.words[1].front() != '-';
    const std::string help = help_of(line.words[0] + (has_subcommand ? " " + line.words[1] : ""));
    ASSERT_FALSE(help.empty()) << "no such subcommand: " << line.words[1];
    for (const std::string& word : line.words) {
      if (word.rfind("--", 0) != 0) continue;
      const std::string option = word.substr(0, word.find('='));
      EXPECT_TRUE(names(help, option)) << option;
    }
  }
}

}  // namespace
