// SPDX-License-Identifier: Apache-2.0
#include "service/cl/interpreter.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace meridian::cl {
namespace {
constexpr std::size_t kMostWarnings = 100;

std::string quoted(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string out = "'";
  for (const char c : text.substr(0, kMost)) out.push_back(c >= ' ' && c < '\x7f' ? c : '?');
  return out + (text.size() > kMost ? "...'" : "'");
}

/// Words that end a path or change tool, place, frame or unit: none may stand inside an arc.
bool breaks_arc(Word word) {
  switch (word) {
    case Word::kEndOfPath:
    case Word::kToolPath:
    case Word::kLoadTool:
    case Word::kLoad:
    case Word::kFrom:
    case Word::kUnits:
    case Word::kTransform:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::string short_number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

Interpreter::Interpreter(std::string name, ClReaderOptions options)
    : name_(std::move(name)), options_(std::move(options)) {
  if (options_.frame) {
    frame_ = *options_.frame;
    frame_is_identity_ = is_identity(frame_);
    axis_ = axis_before_ = frame_.direction(axis_);
  }
  for (std::string& word : options_.allowed_words) {
    for (char& c : word) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
}

tl::unexpected<ClError> Interpreter::refuse(std::uint32_t line, std::string message,
                                            std::string remedy) const {
  return tl::make_unexpected(ClError{name_, line, std::move(message), std::move(remedy)});
}

bool Interpreter::is_new_warning(std::string_view key) const {
  return warnings_.size() < kMostWarnings &&
         std::find(warned_.begin(), warned_.end(), key) == warned_.end();
}

void Interpreter::add_warning(std::string_view key, std::uint32_t line, std::string message) {
  warned_.emplace_back(key);
  warnings_.push_back({line, std::move(message)});
}

ClBlock Interpreter::block(BlockKind kind, std::uint32_t line) const {
  ClBlock b;
  b.line = line;
  b.kind = kind;
  b.tip_mm = to_array(tip_);
  b.axis = to_array(axis_);
  return b;
}

void Interpreter::emit(ClBlock b, Blocks& out) {
  b.sequence = sequence_++;
  ++summary_.blocks;
  ++summary_.blocks_by_kind[static_cast<std::size_t>(b.kind)];
  out.push_back(b);
}

void Interpreter::action(BlockKind kind, ActionKind what, double value, std::uint32_t line,
                         Blocks& out) {
  ClBlock b = block(kind, line);
  b.action = what;
  b.value = value;
  emit(b, out);
}

void Interpreter::vendor_word(const Statement& s, Blocks& out) {
  ClBlock b = block(BlockKind::kAuxiliary, s.line);
  b.action = ActionKind::kVendorWord;
  std::string text(s.major);
  if (!s.rest.empty()) text += "/";
  for (const char c : s.rest) {
    if (c != ' ' && c != '\t') text.push_back(c);
  }
  if (text.size() >= sizeof b.text) {
    warn_once("vendor:" + std::string(s.major), s.line, [&] {
      return std::string("vendor word " + quoted(text) + " is cut to " +
                         std::to_string(sizeof b.text - 1) + " characters");
    });
  }
  std::memcpy(b.text, text.data(), std::min(text.size(), sizeof b.text - 1));
  if (s.number_count > 0) {
    for (std::size_t i = 0; i < s.argument_count; ++i) {
      if (s.arguments[i].is_number) {
        b.value = s.arguments[i].number;
        break;
      }
    }
  }
  emit(b, out);
}

Interpreter::Result Interpreter::take_unknown(const Statement& s, Blocks& out) {
  const auto& allowed = options_.allowed_words;
  if (std::find(allowed.begin(), allowed.end(), s.major) != allowed.end()) {
    vendor_word(s, out);
    return {};
  }
  if (s.major.empty()) {
    return refuse(s.line, "statement without a word: " + quoted(s.rest),
                  "a continuation line whose '$' is missing?");
  }
  return refuse(
      s.line, "unknown word " + quoted(s.major),
      "--allow-unknown " + std::string(s.major) + " passes it to the machine as a vendor word");
}

Interpreter::Result Interpreter::take(const Statement& s, Blocks& out) {
  const bool is_behind_end = end_told_;
  const std::size_t before = out.size();
  auto done = read(s, out);
  if (done && is_behind_end) return judge_behind_end(s, before, out);
  return done;
}

Interpreter::Result Interpreter::read(const Statement& s, Blocks& out) {
  ++summary_.statements;
  if (s.is_catia_matrix) {
    summary_.dialect = "CATIA APT";
    return take_frame(s, Word::kCsys);
  }
  if (s.is_comment_data) {  // only some of these carry what the path needs
    summary_.dialect = "Creo NCL";
    const Word word = find_word(s.major);
    if (word == Word::kCsys) return take_frame(s, word);
    if (word == Word::kToolData) take_tool_data(s);
    return {};
  }
  const Word word = find_word(s.major);
  if (word == Word::kUnknown) return take_unknown(s, out);
  ++known_words_;
  if (word == Word::kGoto) return take_goto(s, out);
  return dispatch(word, s, out);
}

Interpreter::Result Interpreter::dispatch(Word word, const Statement& s, Blocks& out) {
  if (word != Word::kFeed && word != Word::kUnits && word != Word::kRapid && word != Word::kArc &&
      word != Word::kFrom && word != Word::kGoDelta) {
    promises_end_ = true;
  }
  if (arc_.form != ArcForm::kNone && breaks_arc(word)) {
    return refuse(s.line, std::string(s.major) + " between CIRCLE and the GOTO that ends the arc");
  }
  switch (word) {
    case Word::kUnknown:
    case Word::kGoto:
      break;  // taken before
    case Word::kSilent:
      if (s.major.starts_with("PPWORD")) summary_.dialect = "Creo NCL";
      break;
    case Word::kDisplay:
      ++summary_.display_words;
      warn_once(s.major, s.line,
                [&] { return std::string(std::string(s.major) + " is for viewers and skipped"); });
      break;
    case Word::kSkipped:
      if (s.major.starts_with("CSI_")) summary_.dialect = "SolidWorks CAM APT";
      warn_once(s.major, s.line, [&] {
        return std::string(std::string(s.major) + " is skipped: it does not shape the path");
      });
      break;
    case Word::kInsert:
      warn_once(s.major, s.line, [&] {
        return std::string(
            "INSERT is text for another control and skipped, here and further on: what it would do "
            "there is not done");
      });
      break;
    case Word::kRefused:
      return refuse(s.line, std::string(s.major) + " " + std::string(refusal(s.major)));
    case Word::kVendor:
      vendor_word(s, out);
      break;
    case Word::kArc:
      return take_circle(s);
    case Word::kGoDelta:
      return take_delta(s, out);
    case Word::kFrom:
      return take_from(s);
    case Word::kRapid:
      return take_rapid(s);
    case Word::kFeed:
      return take_feed(s);
    case Word::kUnits:
      return take_units(s);
    case Word::kMsys:
    case Word::kCsys:
      return take_frame(s, word);
    case Word::kTransform:
      return take_transform(s);
    case Word::kToolAxis:
      return take_tool_axis(s);
    case Word::kForward:
      return take_forward(s);
    case Word::kToolOn:
      return take_tool_on(s, out);
    case Word::kLoadTool:
      return take_tool(s, false, out);
    case Word::kLoad:
      return take_tool(s, true, out);
    case Word::kToolData:
      take_tool_data(s);
      break;
    case Word::kToolPath:
      return take_tool_path(s);
    case Word::kEndOfPath:
      open_path_line_ = 0;
      path_closed_ = true;
      break;
    case Word::kSpindle:
      return take_spindle(s, out);
    case Word::kCoolant:
      return take_coolant(s, out);
    case Word::kDelay:
      return take_delay(s, out);
    case Word::kStop:
      action(BlockKind::kStop, ActionKind::kStop, 0, s.line, out);
      break;
    case Word::kOptionStop:
      action(BlockKind::kOptionalStop, ActionKind::kStop, 0, s.line, out);
      break;
    case Word::kEnd:
    case Word::kFini:
      return take_end(s, word == Word::kFini, out);
    case Word::kSet:
      return take_mode(s);
    case Word::kCycle:
      return take_cycle(s);
    case Word::kCutCom:
      if (!s.has_word("OFF")) {
        warn_once("CUTCOM", s.line, [&] {
          return std::string(
              "CUTCOM is not applied: the path is taken as the path of the tool tip, as written");
        });
      }
      break;
    case Word::kOrigin:
      for (std::size_t i = 0; i < s.argument_count && i < 3; ++i) {
        if (!s.arguments[i].is_number || s.arguments[i].number != 0) {
          return refuse(s.line, "ORIGIN shifts the points of the file",
                        "output them in the machining axis system, ORIGIN/0,0,0");
        }
      }
      break;
    case Word::kProgram:
      if (summary_.program.empty()) summary_.program = std::string(s.rest.substr(0, 80));
      break;
    case Word::kNote:
      return take_note(s);
  }
  return {};
}

}  // namespace meridian::cl
