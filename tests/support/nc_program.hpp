// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "meridian/kinematics/joints.hpp"

/// A reader of the NC programs that the postprocessor writes, as a controller would: modal words,
/// comments left out. It knows the four dialects by their words and nothing of their writer.
namespace meridian::test {

/// Where drives are that go evenly from `a` to `b`.
[[nodiscard]] inline JointVector between(const JointVector& a, const JointVector& b, double share) {
  JointVector out{};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = a[i] + share * (b[i] - a[i]);
  return out;
}

/// One motion block with everything that is in force behind it.
struct NcMove {
  int line = 0;
  std::uint32_t cl_line = 0;  ///< N word
  bool is_rapid = false;
  bool is_inverse = false;           ///< G93 in force
  bool is_tool_centre = false;       ///< G43.4, G43.5, TRAORI or FUNCTION TCPM in force
  bool has_feed = false;             ///< F stands in this very block
  double feed = 0;                   ///< the last F
  std::map<std::string, double> at;  ///< value of every axis word so far
};

struct NcProgramRead {
  std::vector<NcMove> moves;
  std::vector<std::string> lines;  ///< without comments, as they stand

  [[nodiscard]] bool has(const std::string& line) const {
    for (const std::string& each : lines) {
      if (each == line) return true;
    }
    return false;
  }
};

namespace nc {

struct Words {
  std::map<std::string, double> number;  ///< by address; the last of each
  std::set<std::string> bare;            ///< words without a number, and G and M codes as written
};

inline std::string without_comment(const std::string& line) {
  std::string out;
  int depth = 0;
  for (const char c : line) {
    if (c == ';') break;
    if (c == '(') ++depth;
    if (depth == 0) out += c;
    if (c == ')') --depth;
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

inline Words split(const std::string& line) {
  Words words;
  std::size_t i = 0;
  while (i < line.size() && std::isdigit(static_cast<unsigned char>(line[i])) != 0) ++i;
  while (i < line.size()) {
    if (std::isalpha(static_cast<unsigned char>(line[i])) == 0) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < line.size() && std::isalpha(static_cast<unsigned char>(line[end])) != 0) ++end;
    std::string address = line.substr(i, end - i);
    // A1=..., and letters only otherwise.
    std::size_t digits = end;
    while (digits < line.size() && std::isdigit(static_cast<unsigned char>(line[digits])) != 0)
      ++digits;
    if (digits < line.size() && line[digits] == '=') {
      address = line.substr(i, digits - i);
      end = digits + 1;
    }
    std::size_t stop = end;
    while (stop < line.size() && (std::isdigit(static_cast<unsigned char>(line[stop])) != 0 ||
                                  line[stop] == '.' || line[stop] == '+' || line[stop] == '-')) {
      ++stop;
    }
    if (stop == end) {
      words.bare.insert(address);
    } else if (address == "G" || address == "M") {
      words.bare.insert(line.substr(i, stop - i));
    } else {
      words.number[address] = std::strtod(line.c_str() + end, nullptr);
    }
    i = stop;
  }
  return words;
}

inline bool is_axis(const std::string& address) {
  static const std::set<std::string> kKnown = {"X",  "Y",  "Z",  "A",  "B",  "C",  "U",  "V",
                                               "W",  "I",  "J",  "K",  "A3", "B3", "C3", "TX",
                                               "TY", "TZ", "J1", "J2", "J3", "J4", "J5", "J6"};
  return kKnown.count(address) > 0;
}

}  // namespace nc

[[nodiscard]] inline NcProgramRead read_nc(const std::string& text) {
  NcProgramRead out;
  NcMove state;
  int number = 0;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (const auto mark = line.find("; CL "); mark != std::string::npos) {
      state.cl_line = static_cast<std::uint32_t>(std::atoi(line.c_str() + mark + 5));
    }
    line = nc::without_comment(line);
    if (line.empty() || line == "%") continue;
    out.lines.push_back(line);
    const nc::Words words = nc::split(line);
    const auto has = [&words](const char* word) { return words.bare.count(word) > 0; };
    const bool is_klartext = has("L") || has("LN");
    if (has("G93")) state.is_inverse = true;
    if (has("G94")) state.is_inverse = false;
    if (has("G43.4") || has("G43.5") || has("TRAORI")) state.is_tool_centre = true;
    if (has("FUNCTION") && has("TCPM")) state.is_tool_centre = !has("RESET");
    if (has("G49") || has("TRAFOOF")) state.is_tool_centre = false;
    // Dwells, moves to machine positions and cycle words have axis letters of other meaning.
    if (has("G4") || has("G28") || has("SUPA") || has("M91") || has("CYCL") || has("TOOL") ||
        has("FUNCTION") || has("PGM")) {
      continue;
    }
    if (has("G0") || has("FMAX")) state.is_rapid = true;
    if (has("G1") || (is_klartext && words.number.count("F") > 0)) state.is_rapid = false;
    state.has_feed = words.number.count("F") > 0;
    if (state.has_feed) state.feed = words.number.at("F");
    if (words.number.count("N") > 0) {
      state.cl_line = static_cast<std::uint32_t>(words.number.at("N"));
    }
    bool is_move = false;
    for (const auto& [address, value] : words.number) {
      if (!nc::is_axis(address)) continue;
      state.at[address] = value;
      is_move = true;
    }
    if (!is_move) continue;
    state.line = number;
    out.moves.push_back(state);
  }
  return out;
}

}  // namespace meridian::test
