// SPDX-License-Identifier: Apache-2.0
#include "service/cl/foreign.hpp"

#include <algorithm>
#include <array>
#include <cctype>

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

std::string in_capitals(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return out;
}

bool has(std::string_view text, std::string_view what) {
  return text.find(what) != std::string_view::npos;
}

void skip_blanks(std::string_view& text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
}

/// Takes a letter address with its number ("X-1.5", "G 1", "Z=_HOME") off the front.
bool take_address(std::string_view& text) {
  if (text.empty() || std::isalpha(static_cast<unsigned char>(text.front())) == 0) return false;
  std::string_view rest = text.substr(1);
  skip_blanks(rest);
  if (!rest.empty() && rest.front() == '=') rest.remove_prefix(1);
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

std::string name_of(const std::string& text, bool percent, bool o_number) {
  if (has(text, "BEGIN PGM")) return "a Heidenhain NC program (BEGIN PGM)";
  for (const std::string_view word :
       {"TRAORI", "TRAFOOF", "CYCLE832", "CYCLE800", "SUPA", "DEF REAL", "G710", "_N_", "MSG("}) {
    if (has(text, word)) return "a Siemens NC program (" + std::string(word) + ")";
  }
  for (const std::string_view word : {"M428", "M429", "O<", "#<", "G43.1"}) {
    if (has(text, word)) return "a LinuxCNC NC program (" + std::string(word) + ")";
  }
  for (const std::string_view word : {"G43.4", "G43.5", "G54.1", "G54.2", "G05.1", "G68.2"}) {
    if (has(text, word)) return "a Fanuc NC program (" + std::string(word) + ")";
  }
  if (percent && o_number) return "a Fanuc NC program (% and O number)";
  if (has(text, "G93") || percent) return "an NC program (G code, LinuxCNC or its like)";
  return "an NC program (G code)";
}

}  // namespace

std::string recognise_foreign(std::string_view head) {
  for (const Magic& magic : kMagics) {
    if (head.starts_with(magic.bytes)) return std::string(magic.name);
  }
  const auto control = std::count_if(head.begin(), head.end(), [](unsigned char c) {
    return c < ' ' && c != '\t' && c != '\n' && c != '\r' && c != '\f' && c != '\x1a';
  });
  if (control > 0 && (head.find('\0') != std::string_view::npos ||
                      control * 20 > static_cast<std::ptrdiff_t>(head.size()))) {
    return "binary data";
  }
  const std::string text = in_capitals(head);
  if (has(text, "BEGIN PGM")) return name_of(text, false, false);
  std::size_t lines = 0;
  std::size_t addresses = 0;
  std::size_t words = 0;
  bool percent = false;
  bool o_number = false;
  std::string_view rest = text;
  while (!rest.empty() && lines < 400) {
    const std::size_t stop = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, stop);
    rest.remove_prefix(std::min(stop + 1, rest.size()));
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    skip_blanks(line);
    if (line.empty() || line.front() == ';' || line.front() == '(' || line.starts_with("$$")) {
      continue;
    }
    if (line.front() == '%') {
      percent = true;
      continue;
    }
    ++lines;
    if (line.starts_with("GOTO") || line.starts_with("FEDRAT") || line.starts_with("CIRCLE") ||
        line.starts_with("LOADTL") || line.starts_with("PARTNO") || line.starts_with("UNITS")) {
      ++words;
    }
    o_number |= line.size() > 1 && line.front() == 'O' &&
                std::isdigit(static_cast<unsigned char>(line[1])) != 0;
    addresses += is_address_line(line) ? 1 : 0;
  }
  if (words > 0 || lines == 0) return {};
  const std::string name = name_of(text, percent, o_number);
  const bool is_named = !name.starts_with("an NC program");
  const bool is_gcode =
      addresses * 2 > lines || (is_named && addresses * 4 > lines) || (percent && addresses > 0);
  return is_gcode ? name : std::string{};
}

}  // namespace meridian::cl
