// SPDX-License-Identifier: Apache-2.0
#include "fences/budget_fence.hpp"

#include <algorithm>
#include <regex>
#include <sstream>

namespace meridian::fences {
namespace {

[[nodiscard]] std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(trimmed(part));
  return parts;
}

[[nodiscard]] std::string wanted_text(const std::string& row) {
  constexpr std::string_view kCounted = "instructions_";
  if (!row.starts_with(kCounted)) return "\"" + row + "\"";
  return "within_budget(\"" + row.substr(kCounted.size()) + "\"";
}

}  // namespace

std::vector<std::string> find_unread_budgets(const std::vector<std::string>& rows,
                                             const std::vector<SourceFile>& sources) {
  std::vector<std::string> unread;
  for (const std::string& row : rows) {
    const std::string wanted = wanted_text(row);
    const auto names_it = [&wanted](const SourceFile& file) {
      return std::any_of(file.lines.begin(), file.lines.end(), [&wanted](const std::string& line) {
        return line.find(wanted) != std::string::npos;
      });
    };
    if (std::none_of(sources.begin(), sources.end(), names_it)) unread.push_back(row);
  }
  return unread;
}

std::vector<BudgetRow> read_budget_rows(const SourceFile& page, const std::string& heading) {
  static const std::regex kName("`([a-z][a-z0-9_]*)`");
  std::vector<BudgetRow> rows;
  bool is_behind = false, is_in = false;
  for (std::size_t i = 0; i < page.lines.size(); ++i) {
    const std::string& line = page.lines[i];
    is_behind = is_behind || line.starts_with(heading);
    if (!is_behind) continue;
    if (!line.starts_with("|")) {
      if (is_in) break;
      continue;
    }
    is_in = true;
    const std::vector<std::string> cells = split(line.substr(1), '|');
    if (cells.size() < 2) continue;
    BudgetRow row{i + 1, {}, split(cells[1], ';')};
    for (std::sregex_iterator at(cells[0].begin(), cells[0].end(), kName), end; at != end; ++at) {
      row.names.push_back((*at)[1]);
    }
    if (!row.names.empty()) rows.push_back(row);
  }
  return rows;
}

}  // namespace meridian::fences
