// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/fanuc_codes.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "service/programs/cl/text/letters.hpp"

namespace meridian::cl {
namespace {

/// A G code, and what has to stand behind it.
struct FanucCode {
  std::string_view number;
  std::string_view rest = {};
};
/// LinuxCNC has splines in G5 and G5.1, and G8 of lathes.
constexpr std::array kOfFanuc = std::to_array<FanucCode>({
    {"43.4"},
    {"43.5"},
    {"54.1"},
    {"54.2"},
    {"54.4"},
    {"53.1"},
    {"5.1", "Q"},
    {"5", "P10000"},
    {"8", "P1"},
    {"68.2"},
    {"234"},
    {"254"},
});
constexpr std::array kLikeFanuc = std::to_array<FanucCode>({{"43"}, {"49"}, {"28"}, {"80"}});

std::string_view after_blanks(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(" \t"), text.size()));
}

/// Whether `text`, behind a G, begins with that code. Leading zeros do not count.
bool is_fanuc_code(std::string_view text, const FanucCode& code) {
  text = after_blanks(text);
  while (text.size() > 1 && text.front() == '0') text.remove_prefix(1);
  if (!text.starts_with(code.number)) return false;
  text.remove_prefix(code.number.size());
  if (!text.empty() && (text.front() == '.' || is_digit(text.front()))) return false;
  return after_blanks(text).starts_with(code.rest);
}

std::string find_fanuc_code(std::string_view text, std::span<const FanucCode> codes) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '(' || text[at] == ';') {
      at = text.find_first_of(text[at] == '(' ? ")\n" : "\n", at);
      if (at == std::string_view::npos) break;
    }
    if (text[at] != 'G' || (at > 0 && is_letter(text[at - 1]))) continue;
    const auto found = std::find_if(codes.begin(), codes.end(), [&](const FanucCode& code) {
      return is_fanuc_code(text.substr(at + 1), code);
    });
    if (found == codes.end()) continue;
    return "G" + std::string(found->number) + (found->rest.empty() ? "" : " ") +
           std::string(found->rest);
  }
  return {};
}

}  // namespace

std::string code_of_fanuc(std::string_view text) { return find_fanuc_code(text, kOfFanuc); }
std::string code_like_fanuc(std::string_view text) { return find_fanuc_code(text, kLikeFanuc); }

}  // namespace meridian::cl
