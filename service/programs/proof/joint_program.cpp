// SPDX-License-Identifier: Apache-2.0
#include "service/programs/proof/joint_program.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "service/programs/post/axis_words.hpp"

namespace meridian::proof {
namespace {

struct Word {
  std::string address;
  double value = 0;
};

/// What a line asks for before it is carried out.
struct LineWords {
  std::vector<std::pair<int, double>> axes;  ///< drive and word
  std::optional<double> feed;
  std::optional<int> tool;
  std::optional<int> motion;  ///< 0 or 1, in this very line
  bool has_dwell = false, is_away = false, is_tool_change = false, is_end = false;
};

[[nodiscard]] bool is_letter(char c) { return c >= 'A' && c <= 'Z'; }

/// Comments out; false where a bracket is not closed.
[[nodiscard]] bool strip(std::string& line) {
  std::string out;
  bool is_inside = false;
  for (const char c : line) {
    if (c == ';' && !is_inside) break;
    if (c == '(') {
      if (is_inside) return false;
      is_inside = true;
    } else if (c == ')') {
      if (!is_inside) return false;
      is_inside = false;
    } else if (!is_inside) {
      out += c;
    }
  }
  while (!out.empty() && std::isspace(static_cast<unsigned char>(out.back())) != 0) out.pop_back();
  line = out;
  return !is_inside;
}

/// "X12.5", "J1=-90.00000", each parted by blanks. Nothing where the line is no row of words.
[[nodiscard]] std::optional<std::vector<Word>> words_of(const std::string& line) {
  std::vector<Word> words;
  std::size_t at = 0;
  while (at < line.size()) {
    if (line[at] == ' ' || line[at] == '\t') {
      ++at;
      continue;
    }
    if (!is_letter(line[at])) return std::nullopt;
    Word word;
    word.address = line[at++];
    const std::size_t equals = line.find('=', at);
    if (equals != std::string::npos && equals > at && equals - at <= 2) {
      for (; at < equals; ++at) {
        if (line[at] < '0' || line[at] > '9') return std::nullopt;
        word.address += line[at];
      }
      ++at;
    }
    const char* const begin = line.data() + at;
    const char* const end = line.data() + line.size();
    const auto read = std::from_chars(begin, end, word.value, std::chars_format::fixed);
    if (read.ec != std::errc() || !std::isfinite(word.value)) return std::nullopt;
    at += static_cast<std::size_t>(read.ptr - begin);
    words.push_back(word);
  }
  return words;
}

/// One program in its modal states.
class Reader {
 public:
  Reader(const MachineModel& model, const post::AxisWords& words) : model_(model), words_(words) {}

  /// Empty: taken.
  [[nodiscard]] std::string take(const std::string& text, std::uint32_t line) {
    line_ = line;
    const auto words = words_of(text);
    if (!words) return "no row of words: " + text;
    LineWords asked;
    std::array<bool, 128> is_seen{};
    for (const Word& word : *words) {
      if (const std::string why = add(word, asked, is_seen); !why.empty()) return why;
    }
    return carry_out(asked);
  }

  [[nodiscard]] bool is_ended() const noexcept { return is_ended_; }
  [[nodiscard]] std::vector<ProgramStep> steps() && { return std::move(steps_); }

 private:
  [[nodiscard]] std::string add(const Word& word, LineWords& asked, std::array<bool, 128>& seen) {
    if (const int axis = words_.find(word.address); axis >= 0) {
      for (const auto& [other, value] : asked.axes) {
        if (other == axis) return word.address + " stands twice in the line";
      }
      asked.axes.emplace_back(axis, word.value);
      return "";
    }
    const char letter = word.address[0];
    if (word.address.size() > 1) return "machine " + model_.name + " has no axis " + word.address;
    const int code = static_cast<int>(std::lround(10 * word.value));
    if (letter == 'G') return add_g(code, asked);
    if (letter == 'M') return add_m(code, asked);
    if (std::exchange(seen[static_cast<std::size_t>(letter)], true)) {
      return std::string(1, letter) + " stands twice in the line";
    }
    switch (letter) {
      case 'F':
        if (!(word.value > 0)) return "a feed that is not positive";
        asked.feed = word.value;
        return "";
      case 'T':
        if (code % 10 != 0 || code < 0) return "T wants a whole number";
        asked.tool = code / 10;
        return "";
      case 'N':
      case 'S':
      case 'P':
        return "";
      default:
        return "machine " + model_.name + " has no axis " + word.address;
    }
  }

  /// `code` is ten times the number.
  [[nodiscard]] std::string add_g(int code, LineWords& asked) {
    switch (code) {
      case 0:
      case 10:
        if (asked.motion) return "two kinds of motion in one line";
        asked.motion = code / 10;
        return "";
      case 40:
        asked.has_dwell = true;
        return "";
      case 210:
        is_metric_ = true;
        return "";
      case 900:
        is_absolute_ = true;
        return "";
      case 930:
      case 940:
        if (is_inverse_ != (code == 930)) feed_ = 0;
        is_inverse_ = code == 930;
        return "";
      case 910:
        is_absolute_ = false;  // no motion but G28's until G90 comes
        return "";
      case 280:
      case 530:
        asked.is_away = true;
        return "";
      case 170:
      case 400:
      case 490:
      case 800:
      case 540:
      case 550:
      case 560:
      case 570:
      case 580:
      case 590:
        return "";
      default:
        return "G" + std::to_string(code / 10) +
               (code % 10 != 0 ? "." + std::to_string(code % 10) : "") +
               " is no word of a joint program";
    }
  }

  [[nodiscard]] static std::string add_m(int code, LineWords& asked) {
    switch (code) {
      case 60:
        asked.is_tool_change = true;
        return "";
      case 20:
      case 300:
        asked.is_end = true;
        return "";
      case 0:
      case 10:
      case 30:
      case 40:
      case 50:
      case 70:
      case 80:
      case 90:
        return "";
      default:
        if (code > 300 && code % 10 == 0) return "";  // the machine's own: through coolant
        return "M" + std::to_string(code / 10) + " is no word of a joint program";
    }
  }

  [[nodiscard]] std::string carry_out(const LineWords& asked) {
    if (is_ended_) return "the program goes on after its end";
    if (asked.is_tool_change) {
      if (!asked.tool || !asked.axes.empty()) return "a tool change is Tn M6 alone";
      steps_.push_back({ProgramStep::Kind::kTool, line_, *asked.tool, drives_, is_placed()});
      return "";
    }
    if (asked.is_end) {
      is_ended_ = true;
      steps_.push_back({ProgramStep::Kind::kEnd, line_, 0, drives_, is_placed()});
      return "";
    }
    if (asked.is_away) return go_away(asked);
    if (asked.motion) motion_ = asked.motion;
    if (asked.feed) feed_ = *asked.feed;
    if (asked.axes.empty()) return "";
    return go(asked);
  }

  /// G53, G28: where the axes are then is the control's alone.
  [[nodiscard]] std::string go_away(const LineWords& asked) {
    for (const auto& [axis, value] : asked.axes) known_[static_cast<std::size_t>(axis)] = false;
    steps_.push_back({ProgramStep::Kind::kAway, line_, 0, drives_, is_placed()});
    return "";
  }

  [[nodiscard]] std::string go(const LineWords& asked) {
    if (asked.has_dwell) return "a dwell with axis words";
    if (!is_metric_ || !is_absolute_) return "motion before G21 and G90 are known";
    if (!motion_) return "motion before G0 or G1 is known";
    const bool is_cut = *motion_ == 1;
    if (is_cut && is_inverse_ && !asked.feed) return "a cut in inverse time (G93) without F";
    if (is_cut && !(feed_ > 0)) return "a cut without a feed";
    for (const auto& [axis, value] : asked.axes) {
      drives_[axis] = words_.axis(axis, value);
      known_[static_cast<std::size_t>(axis)] = true;
    }
    steps_.push_back({is_cut ? ProgramStep::Kind::kCut : ProgramStep::Kind::kRapid, line_, 0,
                      drives_, is_placed()});
    return "";
  }

  [[nodiscard]] bool is_placed() const noexcept {
    for (int i = 0; i < words_.count(); ++i) {
      if (!known_[static_cast<std::size_t>(i)]) return false;
    }
    return true;
  }

  const MachineModel& model_;
  const post::AxisWords& words_;
  std::vector<ProgramStep> steps_;
  JointVector drives_{};
  std::array<bool, kMaxJoints> known_{};
  std::optional<int> motion_;
  double feed_ = 0;
  std::uint32_t line_ = 0;
  bool is_metric_ = false, is_absolute_ = false, is_inverse_ = false, is_ended_ = false;
};

}  // namespace

Expected<std::vector<ProgramStep>, ProgramError> read_joint_program(std::istream& in,
                                                                    const MachineModel& model) {
  const auto words = post::AxisWords::of(model);
  if (!words) return tl::make_unexpected(ProgramError{0, words.error().message});
  Reader reader(model, *words);
  std::uint32_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (!strip(line)) return tl::make_unexpected(ProgramError{number, "a bracket is not closed"});
    if (line.empty() || line == "%") continue;
    if (const std::string why = reader.take(line, number); !why.empty()) {
      return tl::make_unexpected(ProgramError{number, why});
    }
  }
  if (!reader.is_ended()) {
    return tl::make_unexpected(ProgramError{number, "the program has no end (M2 or M30)"});
  }
  return std::move(reader).steps();
}

bool is_nc_program(const std::string& head) {
  std::size_t at = 0;
  while (at < head.size() && std::isspace(static_cast<unsigned char>(head[at])) != 0) ++at;
  if (at >= head.size()) return false;
  if (head[at] == '%' || head[at] == '(' || head[at] == ';') return true;
  return is_letter(head[at]) && at + 1 < head.size() && head[at + 1] >= '0' && head[at + 1] <= '9';
}

}  // namespace meridian::proof
