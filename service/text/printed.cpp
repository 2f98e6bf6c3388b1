// SPDX-License-Identifier: Apache-2.0
#include "service/text/printed.hpp"

#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace meridian::text {

namespace {

/// Leaves `arguments` read.
void append_list(std::string& text, const char* format, std::va_list arguments) {
  std::va_list again;
  va_copy(again, arguments);
  const int size = std::vsnprintf(nullptr, 0, format, arguments);
  const std::size_t before = text.size();
  if (size > 0) {
    text.resize(before + static_cast<std::size_t>(size));
    std::vsnprintf(text.data() + before, static_cast<std::size_t>(size) + 1, format, again);
  }
  va_end(again);
}

}  // namespace

std::string printed(const char* format, ...) {
  std::string text;
  std::va_list arguments;
  va_start(arguments, format);
  append_list(text, format, arguments);
  va_end(arguments);
  return text;
}

void append(std::string& text, const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  append_list(text, format, arguments);
  va_end(arguments);
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

std::string json_number(const char* format, double value) {
  if (!std::isfinite(value)) return "null";
  std::string out;
  append(out, format, value);
  return out;
}

}  // namespace meridian::text
