// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/foreign.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "service/programs/cl/fanuc_codes.hpp"
#include "service/programs/cl/text/statement.hpp"
#include "service/programs/cl/words/word_table.hpp"

namespace meridian::cl {
namespace {

struct Magic {
  std::string_view bytes;
  std::string_view name;
};

constexpr std::array kMagics = std::to_array<Magic>({
    {std::string_view("PK\x03\x04", 4), "a ZIP archive"},
    {std::string_view("\x1f\x8b", 2), "gzip data"},
    {std::string_view("%PDF", 4), "a PDF document"},
    {std::string_view("\x7f"
                      "ELF",
                      4),
     "an executable"},
    {std::string_view("\xff\xfe", 2), "UTF-16 text (convert it: iconv -f UTF-16 -t UTF-8)"},
    {std::string_view("\xfe\xff", 2), "UTF-16 text (convert it: iconv -f UTF-16 -t UTF-8)"},
    {std::string_view("ISO-10303-21", 12), "a STEP file"},
    {std::string_view("<?xml", 5), "an XML document"},
    {std::string_view("solid ", 6), "an STL model"},
});

/// One sign for each kind of blank and of line end.
std::string in_capitals(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) {
    return c == '\t' ? ' ' : c == '\r' ? '\n' : static_cast<char>(std::toupper(c));
  });
  return out;
}

bool has(std::string_view text, std::string_view what) {
  return text.find(what) != std::string_view::npos;
}

void skip_blanks(std::string_view& text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
}

/// Takes a macro value off the front: "#2", "[#1+2]".
bool take_macro(std::string_view& text) {
  std::size_t used = 0;
  if (text.starts_with('#')) {
    used = 1;
    while (used < text.size() && std::isdigit(static_cast<unsigned char>(text[used])) != 0) ++used;
    if (used == 1) return false;
  } else if (text.starts_with('[')) {
    used = std::min(text.find(']'), text.size() - 1) + 1;
  }
  text.remove_prefix(used);
  return used > 0;
}

/// Takes a letter address with its number ("X-1.5", "G 1", "Y#2") off the front.
bool take_address(std::string_view& text) {
  if (text.empty() || std::isalpha(static_cast<unsigned char>(text.front())) == 0) return false;
  std::string_view rest = text.substr(1);
  skip_blanks(rest);
  if (!rest.empty() && rest.front() == '=') rest.remove_prefix(1);
  if (take_macro(rest)) {
    text = rest;
    return true;
  }
  std::size_t digits = 0;
  std::size_t at = 0;
  while (at < rest.size() &&
         (std::isdigit(static_cast<unsigned char>(rest[at])) != 0 || rest[at] == '.' ||
          (at == 0 && (rest[at] == '-' || rest[at] == '+')))) {
    digits += std::isdigit(static_cast<unsigned char>(rest[at])) != 0 ? 1 : 0;
    ++at;
  }
  if (digits == 0) return false;
  text = rest.substr(at);
  return true;
}

/// True for a line of G code: "N10 G1 X1. Y-2.5 F100".
bool is_address_line(std::string_view line) {
  std::size_t addresses = 0;
  skip_blanks(line);
  while (!line.empty() && line.front() != ';' && line.front() != '(') {
    if (!take_address(line)) return false;
    ++addresses;
    skip_blanks(line);
  }
  return addresses > 0;
}

constexpr bool is_word_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

std::string_view leading_word(std::string_view line) {
  std::size_t size = 0;
  while (size < line.size() && (is_word_letter(line[size]) || line[size] == '-')) ++size;
  return line.substr(0, size);
}

/// True for a statement that only CL files have: one of their words, whole, with its slash, or one
/// that takes free text.
bool is_cl_line(std::string_view line) {
  if (line.starts_with("TOOL PATH")) return true;
  const std::string_view word = leading_word(line);
  if (takes_free_text(word)) return true;
  line.remove_prefix(word.size());
  skip_blanks(line);
  return line.starts_with('/') && find_word(word) != nullptr;
}

/// The word of a line that no text but a Siemens program has; empty where there is none.
std::string_view siemens_word(std::string_view line) {
  if (line.starts_with("%_N_")) return "_N_";
  for (std::size_t at = 0; at < line.size() && line[at] != ';';) {
    std::size_t stop = at;
    while (stop < line.size() && is_word_letter(line[stop])) ++stop;
    const std::string_view word = line.substr(at, stop - at);
    if (word == "TRAORI" || word == "TRAFOOF") return word;
    if (word.size() == 8 && word.starts_with("CYCLE8")) return word;  // CYCLE800, CYCLE832, ...
    at = stop + 1;
  }
  return {};
}

/// Heads are checked line by line: how many there are, and of which kind.
struct Lines {
  std::size_t all = 0;
  std::size_t addresses = 0;
  std::size_t cl = 0;
  bool percent = false;
  bool o_number = false;
  bool begins_with_number = false;  ///< of a program: O1001, :1001, or <NAME> behind %
  std::string_view siemens;

  explicit Lines(std::string_view rest) {
    while (!rest.empty() && all < kMax) {
      const std::size_t stop = std::min(rest.find('\n'), rest.size());
      std::string_view line = rest.substr(0, stop);
      rest.remove_prefix(std::min(stop + 1, rest.size()));
      while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
      skip_blanks(line);
      if (!line.empty() && line.front() != ';' && line.front() != '(' && !line.starts_with("$$")) {
        take(line);
      }
    }
  }

 private:
  static constexpr std::size_t kMax = 400;

  /// And nothing behind it that LinuxCNC would have there (O100 sub).
  [[nodiscard]] bool is_program_number(std::string_view line) const {
    if (line.front() == '<') return percent && line.find('>') != std::string_view::npos;
    if (line.front() != 'O' && line.front() != ':') return false;
    line.remove_prefix(1);
    const std::size_t digits = std::min(line.find_first_not_of("0123456789"), line.size());
    line.remove_prefix(digits);
    skip_blanks(line);
    return digits > 0 && (line.empty() || line.front() == '(' || is_address_line(line));
  }

  void take(std::string_view line) {
    if (siemens.empty() && !is_cl_line(line)) siemens = siemens_word(line);
    if (line.front() == '%') {
      percent = true;
      return;
    }
    ++all;
    if (all == 1) begins_with_number = is_program_number(line);
    cl += is_cl_line(line) ? 1 : 0;
    o_number |= line.size() > 1 && line.front() == 'O' &&
                std::isdigit(static_cast<unsigned char>(line[1])) != 0;
    addresses += is_address_line(line) ? 1 : 0;
  }
};

/// Mastercam's NCI: lines in pairs, a code (1050: the version, 1000 to 1025: the head of a path)
/// and its numbers.
bool is_nci(std::string_view text) {
  const std::string_view first = text.substr(0, text.find('\n'));
  const std::string_view code = first.substr(0, first.find_last_not_of(' ') + 1);
  const bool is_head = code.size() == 4 && (code == "1050" || (code >= "1000" && code <= "1025"));
  if (!is_head || code.find_first_not_of("0123456789") != std::string_view::npos) return false;
  const std::string_view rest = text.substr(std::min(first.size() + 1, text.size()));
  const std::string_view second = rest.substr(0, rest.find('\n'));
  const std::string_view numbers = second.substr(0, second.find('"'));  // a text may follow
  return has(numbers, " ") && numbers.find_first_not_of("+-.0123456789 ") == std::string_view::npos;
}

constexpr std::string_view kHeidenhain = "a Heidenhain NC program (BEGIN PGM)";

std::string name_of(const std::string& text, const Lines& lines) {
  if (!lines.siemens.empty()) return "a Siemens NC program (" + std::string(lines.siemens) + ")";
  for (const std::string_view word : {"SUPA", "DEF REAL", "G710", "_N_", "MSG("}) {
    if (has(text, word)) return "a Siemens NC program (" + std::string(word) + ")";
  }
  for (const std::string_view word : {"M428", "M429", "O<", "#<", "G43.1"}) {
    if (has(text, word)) return "a LinuxCNC NC program (" + std::string(word) + ")";
  }
  if (const std::string code = code_of_fanuc(text); !code.empty()) {
    return "a Fanuc NC program (" + code + ")";
  }
  if (lines.percent && lines.o_number) return "a Fanuc NC program (% and O number)";
  if (lines.begins_with_number) return "a Fanuc NC program (program number)";
  if (has(text, "G93") || lines.percent) return "an NC program (G code, LinuxCNC or its like)";
  return "an NC program (G code)";
}

}  // namespace

Recognised recognise_foreign(std::string_view head) {
  constexpr std::size_t kEnoughLines = 32;
  for (const Magic& magic : kMagics) {
    if (head.starts_with(magic.bytes)) {
      return {std::string(magic.name), true, false, Dialect::kUnknown, {}, {}};
    }
  }
  const auto control = std::count_if(head.begin(), head.end(), [](unsigned char c) {
    return c < ' ' && c != '\t' && c != '\n' && c != '\r' && c != '\f' && c != '\x1a';
  });
  if (control > 0 && (head.find('\0') != std::string_view::npos ||
                      control * 20 > static_cast<std::ptrdiff_t>(head.size()))) {
    return {"binary data", true, false, Dialect::kUnknown, {}, {}};
  }
  const std::string text = in_capitals(head);
  if (is_nci(text)) return {"a Mastercam NCI file", true, false, Dialect::kUnknown, {}, {}};
  const Lines lines(text);
  if (lines.cl > 0) return {{}, true, false, Dialect::kUnknown, {}, {}};
  if (has(text, "BEGIN PGM")) {
    return {std::string(kHeidenhain), true, true, Dialect::kHeidenhain, "BEGIN PGM", {}};
  }
  if (lines.all == 0 && lines.siemens.empty()) return {};
  const std::string name = name_of(text, lines);
  const bool is_named = !name.starts_with("an NC program");
  const bool is_gcode = !lines.siemens.empty() || lines.addresses * 2 > lines.all ||
                        (is_named && lines.addresses * 4 > lines.all) ||
                        (lines.percent && lines.addresses > 0);
  const bool is_enough = lines.all >= kEnoughLines;
  Recognised out;
  out.is_certain = is_enough;
  if (!is_gcode) return out;
  out = {name, is_named || is_enough, true, Dialect::kUnknown, {}, {}};
  const auto take = [&](std::string_view begin, Dialect program) {
    if (!name.starts_with(begin)) return;
    out.program = program;
    out.shown_by = name.substr(begin.size(), name.size() - begin.size() - 1);
  };
  out.like_fanuc = code_like_fanuc(text);
  take("a Fanuc NC program (", Dialect::kFanuc);
  take("a Siemens NC program (", Dialect::kSiemens);
  return out;
}

}  // namespace meridian::cl
