// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "service/machine/inspect/pose_table.hpp"

namespace meridian::inspect {
namespace {

std::vector<std::string> cells_of(std::string_view line) {
  constexpr std::string_view kBetween = " \t,;\r";
  std::vector<std::string> cells;
  line = line.substr(0, line.find('#'));
  while (true) {
    const std::size_t begin = line.find_first_not_of(kBetween);
    if (begin == std::string_view::npos) return cells;
    line.remove_prefix(begin);
    const std::size_t size = std::min(line.find_first_of(kBetween), line.size());
    cells.emplace_back(line.substr(0, size));
    line.remove_prefix(size);
  }
}

std::optional<double> number_of(std::string_view cell) {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool is_number =
      error == std::errc() && end == cell.data() + cell.size() && std::isfinite(value);
  return is_number ? std::optional<double>(value) : std::nullopt;
}

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

/// Which column of a table is which; without a row of names the columns in their order.
class Columns {
 public:
  explicit Columns(const std::vector<std::string>& wanted) : wanted_(wanted) {
    for (std::size_t i = 0; i < wanted.size(); ++i) columns_.push_back(i);
  }

  /// Takes a row of names; empty, or what is wrong with it.
  std::string take_names(const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      const auto at = std::find(names.begin(), names.end(), wanted_[i]);
      if (at == names.end()) {
        return "no column " + wanted_[i] + "; needed are " + listed(wanted_);
      }
      columns_[i] = static_cast<std::size_t>(at - names.begin());
    }
    has_names_ = true;
    width_ = names.size();
    return "";
  }

  std::string take_row(const std::vector<std::string>& cells, std::vector<double>& out) const {
    const std::size_t width = has_names_ ? width_ : wanted_.size();
    if (cells.size() != width) {
      return std::to_string(cells.size()) + " values, " + std::to_string(width) + " are needed" +
             (has_names_ ? "" : ": " + listed(wanted_));
    }
    for (const std::size_t at : columns_) {
      const auto value = number_of(cells[at]);
      if (!value) return "'" + cells[at].substr(0, 24) + "' is no finite number";
      out.push_back(*value);
    }
    return "";
  }

 private:
  const std::vector<std::string>& wanted_;
  std::vector<std::size_t> columns_;
  std::size_t width_ = 0;
  bool has_names_ = false;
};

}  // namespace

Expected<std::vector<TableRow>, std::string> read_table(std::istream& in, std::string_view name,
                                                        const std::vector<std::string>& columns) {
  Columns which(columns);
  std::vector<TableRow> rows;
  std::string errors;
  std::uint32_t number = 0;
  bool is_first = true;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const auto cells = cells_of(line);
    if (cells.empty()) continue;
    const bool is_head = is_first && !number_of(cells.front());
    is_first = false;
    TableRow row{number, {}};
    const std::string wrong = is_head ? which.take_names(cells) : which.take_row(cells, row.values);
    if (!wrong.empty()) {
      errors += std::string(name) + ":" + std::to_string(number) + ": " + wrong + "\n";
    } else if (!is_head) {
      rows.push_back(std::move(row));
    }
    if (is_head && !wrong.empty()) break;
  }
  if (errors.empty() && rows.empty()) errors = std::string(name) + ": no row of numbers\n";
  if (!errors.empty()) return tl::make_unexpected(errors);
  return rows;
}

}  // namespace meridian::inspect
