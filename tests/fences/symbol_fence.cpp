// SPDX-License-Identifier: Apache-2.0
#include "fences/symbol_fence.hpp"

#include <array>
#include <cstdio>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace meridian::fences {

std::set<std::string> undefined_symbols(const std::string& object_file) {
  const std::string command = "nm --undefined-only --demangle '" + object_file + "'";
  std::FILE* const nm = popen(command.c_str(), "r");
  if (nm == nullptr) {
    throw std::runtime_error("cannot run nm");
  }
  std::string text;
  std::array<char, 4096> part{};
  while (std::fgets(part.data(), part.size(), nm) != nullptr) {
    text += part.data();
  }
  if (pclose(nm) != 0) {
    throw std::runtime_error("nm failed on " + object_file);
  }
  static const std::regex kLine(R"(^\s+[UwvV]\s+(.*)$)");
  std::set<std::string> symbols;
  for (const std::string& line : split_lines(text)) {
    std::smatch match;
    if (std::regex_match(line, match, kLine) && match[1] != "_GLOBAL_OFFSET_TABLE_") {
      symbols.insert(match[1]);
    }
  }
  return symbols;
}

std::set<std::string> read_symbols(const SourceFile& file) {
  std::set<std::string> symbols;
  for (const std::string& full_line : file.lines) {
    std::string line = full_line.substr(0, full_line.find('#'));
    line.erase(line.find_last_not_of(" \t") + 1);
    if (!line.empty()) {
      symbols.insert(line);
    }
  }
  return symbols;
}

bool is_banned(const std::string& symbol) {
  static const std::regex kBanned(
      R"(operator (new|delete)|malloc|calloc|realloc|free|aligned_alloc|)"
      R"(__cxa_|_Unwind|__gxx_personality|std::__throw|std::terminate|abort|exit|)"
      R"(pthread_|sem_|mtx_|cnd_|std::(mutex|thread|condition)|syscall|write|read|open|)"
      R"(printf|puts|std::basic_|std::ios|std::ostream|clock_|sleep|getenv|dds_)");
  return std::regex_search(symbol, kBanned);
}

std::string difference(const std::set<std::string>& golden, const std::set<std::string>& found) {
  std::ostringstream text;
  for (const std::string& symbol : found) {
    if (!golden.contains(symbol)) {
      text << "new: " << symbol << "\n";
    }
  }
  for (const std::string& symbol : golden) {
    if (!found.contains(symbol)) {
      text << "gone: " << symbol << "\n";
    }
  }
  return text.str();
}

}  // namespace meridian::fences
