// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/toml_guard.hpp"

#include <algorithm>

namespace meridian::config {
namespace {

/// Goes over a text and keeps count of what is open.
class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  [[nodiscard]] std::optional<TomlBomb> run() {
    while (at_ < text_.size()) {
      step();
      if (brackets_ > kMaxTomlDepth) return TomlBomb{line_, "brackets are nested too deep"};
      if (dots_ >= kMaxTomlDepth) return TomlBomb{line_, "a name has too many parts"};
    }
    return std::nullopt;
  }

 private:
  void step() {
    const char c = text_[at_];
    switch (c) {
      case '#':
        at_ = std::min(text_.find('\n', at_), text_.size());
        return;
      case '"':
      case '\'':
        return skip_string(c);
      case '\n':
        ++line_;
        dots_ = 0;
        // A header or a value ends with its line, arrays do not; a bracket that is never closed is
        // the parser's to refuse.
        break;
      case '[':
      case '{':
        ++brackets_;
        dots_ = 0;
        break;
      case ']':
      case '}':
        brackets_ = std::max(0, brackets_ - 1);
        dots_ = 0;
        break;
      case '.':
        ++dots_;
        break;
      case '=':
      case ',':
        dots_ = 0;
        break;
      default:
        break;
    }
    ++at_;
  }

  /// Behind the string that begins here; one without an end goes to the end of its line, or text.
  void skip_string(char quote) {
    const std::string_view rest = text_.substr(at_);
    const bool is_long = rest.size() >= 3 && rest[1] == quote && rest[2] == quote;
    for (at_ += is_long ? 3 : 1; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n' && !is_long) return;
      if (c == '\n') ++line_;
      if (c == '\\' && quote == '"') {
        if (at_ + 1 < text_.size() && text_[at_ + 1] != '\n') ++at_;
      } else if (c == quote && (!is_long || text_.substr(at_, 3) == std::string(3, quote))) {
        at_ += is_long ? 3 : 1;
        return;
      }
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1, brackets_ = 0, dots_ = 0;
};

}  // namespace

std::optional<TomlBomb> find_toml_bomb(std::string_view text) {
  if (text.size() > kMaxTomlBytes) {
    return TomlBomb{0, "the file is too long"};
  }
  return Scan(text).run();
}

}  // namespace meridian::config
