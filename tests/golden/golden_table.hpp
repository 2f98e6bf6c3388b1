// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace meridian::test {

/// A CSV of golden data: `#` comment lines, one line of column names, rows of numbers and words.
class GoldenTable {
 public:
  explicit GoldenTable(const std::filesystem::path& path) {
    std::ifstream in(path);
    if (!in) throw std::runtime_error("no golden data at " + path.string());
    std::string line;
    while (std::getline(in, line)) {
      if (line.empty() || line[0] == '#') continue;
      std::vector<std::string> cells;
      std::istringstream cut(line);
      for (std::string cell; std::getline(cut, cell, ',');) cells.push_back(cell);
      if (names_.empty()) {
        names_ = cells;
      } else {
        cells.resize(names_.size());
        rows_.push_back(cells);
      }
    }
  }

  [[nodiscard]] std::size_t size() const noexcept { return rows_.size(); }

  [[nodiscard]] const std::string& word(std::size_t row, const std::string& column) const {
    return rows_.at(row).at(find(column));
  }

  /// Number of a cell; throws where it is not one.
  [[nodiscard]] double number(std::size_t row, const std::string& column) const {
    return parse(word(row, column));
  }

  /// By place instead of name.
  [[nodiscard]] double number_at(std::size_t row, std::size_t column) const {
    return parse(rows_.at(row).at(column));
  }
  [[nodiscard]] bool is_number(std::size_t row, std::size_t column) const {
    const std::string& cell = rows_.at(row).at(column);
    return cell.find_first_not_of("+-.eE0123456789") == std::string::npos;
  }

  /// The numbers of `count` neighbouring columns that begin with `column`.
  [[nodiscard]] std::vector<double> numbers(std::size_t row, const std::string& column,
                                            std::size_t count) const {
    std::vector<double> out;
    const std::size_t first = find(column);
    for (std::size_t i = 0; i < count; ++i) out.push_back(parse(rows_.at(row).at(first + i)));
    return out;
  }

 private:
  [[nodiscard]] std::size_t find(const std::string& column) const {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i] == column) return i;
    }
    throw std::runtime_error("golden data have no column " + column);
  }

  [[nodiscard]] static double parse(const std::string& cell) {
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    if (cell.empty() || *end != '\0') throw std::runtime_error("not a number: '" + cell + "'");
    return value;
  }

  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace meridian::test
