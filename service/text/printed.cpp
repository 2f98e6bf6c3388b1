// SPDX-License-Identifier: Apache-2.0
#include "service/text/printed.hpp"

#include <cstdarg>
#include <cstdio>

namespace meridian::text {

void append(std::string& text, const char* format, ...) {
  char line[512];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  text += line;
}

std::string json_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (code < 0x20) {
      append(out, "\\u%04x", code);
    } else {
      out += c;
    }
  }
  return out + '"';
}

}  // namespace meridian::text
