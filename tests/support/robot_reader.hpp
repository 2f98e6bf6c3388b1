// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

/// Strict readers of programs in robots' languages, by the languages' grammar: a line that is none
/// of the statements below, in its order, is an error. They know nothing of the writer.
namespace meridian::test {

struct RobotPoint {
  std::vector<double> joints;  ///< degrees; URScript: radians
  double seconds = 0;          ///< time of the move; 0: none is said
  double percent = 0;          ///< of the axes' speed; 0: none is said
};

struct RobotRead {
  std::string name, error;  ///< error: empty where the program is right
  std::vector<RobotPoint> points;
  int halts = 0;
};

namespace robot {

inline const char* const kNumber = R"((-?[0-9]+\.[0-9]+))";

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Numbers that stand behind each other in `text`, parted by what `part` matches, nothing else.
inline std::optional<std::vector<double>> numbers(const std::string& text,
                                                  const std::string& part) {
  std::vector<double> out;
  std::string rest = text;
  const std::regex number(std::string("^") + kNumber), between("^" + part);
  std::smatch match;
  while (true) {
    if (!std::regex_search(rest, match, number)) return std::nullopt;
    out.push_back(std::stod(match[1]));
    rest = match.suffix();
    if (rest.empty()) return out;
    if (!std::regex_search(rest, match, between)) return std::nullopt;
    rest = match.suffix();
  }
}

}  // namespace robot

inline RobotRead read_krl(const std::string& text) {
  RobotRead out;
  static const std::regex def(R"(DEF ([A-Za-z][A-Za-z0-9_]{0,23})\(\))"),
      speed(R"(\$VEL_AXIS\[([1-6])\]=([0-9]{1,3}))"), wait(R"(WAIT SEC [0-9]+\.[0-9]+)"),
      ptp(R"(PTP \{E6AXIS: (.*)\})"), axis(std::string("A([1-6]) ") + robot::kNumber);
  std::map<int, int> percent;
  enum { kHead, kBody, kDone } state = kHead;
  for (const std::string& line : robot::lines_of(text)) {
    std::smatch match;
    out.error = line;
    if (line.size() > 255) return out;
    if (state == kHead) {
      if (std::regex_match(line, match, def)) {
        out.name = match[1];
        state = kBody;
      } else if (line[0] != '&') {
        return out;
      }
    } else if (state == kDone) {
      return out;
    } else if (line == "END") {
      state = kDone;
    } else if (line == "HALT") {
      ++out.halts;
    } else if (std::regex_match(line, match, speed)) {
      percent[std::stoi(match[1])] = std::stoi(match[2]);
      if (std::stoi(match[2]) < 1 || std::stoi(match[2]) > 100) return out;
    } else if (std::regex_match(line, match, ptp)) {
      RobotPoint point;
      std::istringstream parts(match[1]);
      for (std::string part; std::getline(parts, part, ',');) {
        std::smatch words;
        if (!std::regex_match(part, words, axis)) return out;
        point.joints.push_back(std::stod(words[2]));
        const int number = static_cast<int>(point.joints.size());
        if (std::stoi(words[1]) != number || percent.count(number) == 0) return out;
        if (point.percent != 0 && percent[number] != point.percent) return out;
        point.percent = percent[number];
      }
      out.points.push_back(point);
    } else if (line != "BAS (#INITMOV,0)" && line[0] != ';' && !std::regex_match(line, wait)) {
      return out;
    }
  }
  out.error = state == kDone ? "" : "no END";
  return out;
}

inline RobotRead read_rapid(const std::string& text) {
  RobotRead out;
  static const std::regex module(R"(MODULE ([A-Za-z][A-Za-z0-9_]{0,31}))"),
      wait(R"(WaitTime [0-9]+\.[0-9]+;)"),
      move(R"(MoveAbsJ \[\[([^\]]*)\],\[9E9,9E9,9E9,9E9,9E9,9E9\]\]\\NoEOffs,)"
           R"(v(5|10|20|50|100)(\\T:=([0-9]+\.[0-9]+))?,fine,tool0;)");
  enum { kModule, kProc, kBody, kEnd, kDone } state = kModule;
  for (const std::string& line : robot::lines_of(text)) {
    std::smatch match;
    out.error = line;
    if (line[0] == '!' && state != kModule) continue;
    if (state == kModule && std::regex_match(line, match, module)) {
      out.name = match[1];
      state = kProc;
    } else if (state == kProc && line == "PROC main()") {
      state = kBody;
    } else if (state == kBody && line == "ENDPROC") {
      state = kEnd;
    } else if (state == kEnd && line == "ENDMODULE") {
      state = kDone;
    } else if (state == kBody && line == "Stop;") {
      ++out.halts;
    } else if (state == kBody && std::regex_match(line, match, move)) {
      const auto joints = robot::numbers(match[1], ",");
      if (!joints || joints->size() != 6) return out;
      out.points.push_back({*joints, match[4].matched ? std::stod(match[4]) : 0, 0});
    } else if (state != kBody || !std::regex_match(line, wait)) {
      return out;
    }
  }
  out.error = state == kDone ? "" : "no ENDMODULE";
  return out;
}

inline RobotRead read_ls(const std::string& text) {
  RobotRead out;
  static const std::regex prog(R"(/PROG  ([A-Z][A-Z0-9_]{0,35}))"),
      statement(R"(([0-9]+): (.*) ;)"), move(R"(J P\[([0-9]+)\] ([0-9]+)(%|msec) FINE)"),
      wait(R"(WAIT [0-9]+\.[0-9]{2}\(sec\))"), remark(R"(![^;]{0,32})"),
      point(R"(P\[([0-9]+)\]\{)"), joint(R"(J([1-6]) = (-?[0-9]+\.[0-9]+) deg)");
  const std::vector<std::string> lines = robot::lines_of(text);
  std::size_t n = 0;
  const auto next = [&]() -> std::string { return n < lines.size() ? lines[n++] : "end of file"; };
  std::smatch match;
  out.error = next();
  if (!std::regex_match(out.error, match, prog)) return out;
  out.name = match[1];
  if ((out.error = next()) != "/ATTR") return out;
  while ((out.error = next()) != "/MN") {
    if (out.error.empty() || out.error.back() != ';') return out;
  }
  std::vector<RobotPoint> moves;  // in order of P numbers
  int number = 0;
  while ((out.error = next()) != "/POS") {
    const std::string line = out.error;
    if (!std::regex_match(line, match, statement) || std::stoi(match[1]) != ++number) return out;
    const std::string what = match[2];
    if (std::regex_match(what, match, move)) {
      if (std::stoul(match[1]) != moves.size() + 1) return out;
      RobotPoint to;
      (match[3] == "%" ? to.percent : to.seconds) =
          std::stod(match[2]) / (match[3] == "%" ? 1 : 1000);
      moves.push_back(to);
    } else if (what == "PAUSE") {
      ++out.halts;
    } else if (what != "UFRAME_NUM=0" && what != "UTOOL_NUM=1" && !std::regex_match(what, wait) &&
               !std::regex_match(what, remark)) {
      return out;
    }
  }
  for (RobotPoint& to : moves) {
    out.error = next();
    const std::string head = out.error;
    if (!std::regex_match(head, match, point)) return out;
    if (std::stol(match[1]) != &to - moves.data() + 1) return out;
    if ((out.error = next()) != "   GP1:" || (out.error = next()) != "\tUF : 0, UT : 1,")
      return out;
    std::string body, line;
    while ((line = next()) != "};") {
      if (line == "end of file") return out;
      body += line;
    }
    std::istringstream parts(body);
    for (std::string part; std::getline(parts, part, ',');) {
      const std::string word = part.substr(part.find_first_not_of(" \t"));
      if (!std::regex_match(word, match, joint)) return out;
      to.joints.push_back(std::stod(match[2]));
      if (std::stoul(match[1]) != to.joints.size()) return out;
    }
  }
  if ((out.error = next()) != "/END" || n != lines.size()) return out;
  out.points = moves;
  out.error.clear();
  return out;
}

inline RobotRead read_urscript(const std::string& text) {
  RobotRead out;
  static const std::regex def(R"(def ([A-Za-z][A-Za-z0-9_]{0,31})\(\):)"),
      popup(R"(  popup\("[^"]*", title="[^"]*", warning=True, blocking=True\))"),
      sleep(R"(  sleep\([0-9]+\.[0-9]+\))"),
      move(R"(  movej\(\[([^\]]*)\], (t=([0-9]+\.[0-9]+)|a=[0-9.]+, v=[0-9.]+)\))");
  enum { kDef, kBody, kCall, kDone } state = kDef;
  for (const std::string& line : robot::lines_of(text)) {
    std::smatch match;
    out.error = line;
    if (state == kDef && std::regex_match(line, match, def)) {
      out.name = match[1];
      state = kBody;
    } else if (state == kBody && line == "end") {
      state = kCall;
    } else if (state == kCall && line == out.name + "()") {
      state = kDone;
    } else if (state == kBody && std::regex_match(line, popup)) {
      ++out.halts;
    } else if (state == kBody && std::regex_match(line, match, move)) {
      const auto joints = robot::numbers(match[1], ", ");
      if (!joints || joints->size() != 6) return out;
      out.points.push_back({*joints, match[3].matched ? std::stod(match[3]) : 0, 0});
    } else if (state != kBody || (line.substr(0, 4) != "  # " && !std::regex_match(line, sleep))) {
      return out;
    }
  }
  out.error = state == kDone ? "" : "no end";
  return out;
}

}  // namespace meridian::test
