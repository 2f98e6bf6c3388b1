// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/budgets.hpp"

#include <toml++/toml.h>

#include <sstream>
#include <stdexcept>

#include "service/host/process/programs.hpp"

namespace meridian::probe {
namespace {

std::string text_of(const toml::table& row, const char* key, const std::string& name) {
  const auto text = row[key].value<std::string>();
  if (!text) {
    throw std::runtime_error("budget " + name + ": no " + key);
  }
  return *text;
}

[[nodiscard]] toml::table read_table(const std::string& file) {
  return toml::parse_file(file.empty() ? process::shipped_file("budgets.toml").string() : file);
}

[[nodiscard]] Budget read_row(const std::string& name, const toml::table& row) {
  Budget budget;
  budget.name = name;
  budget.what = text_of(row, "what", name);
  budget.statistic = text_of(row, "statistic", name);
  budget.unit = text_of(row, "unit", name);
  budget.checked = text_of(row, "checked", name);
  const auto limit = row["limit"].value<double>();
  const auto factor = row["factor"].value<double>();
  const auto plus = row["plus"].value<double>();
  const auto at_least = row["at_least"].value<double>();
  if (int{limit.has_value()} + int{factor.has_value()} + int{at_least.has_value()} != 1 ||
      factor.has_value() != plus.has_value()) {
    throw std::runtime_error("budget " + name + ": wants one of limit, factor with plus, at_least");
  }
  budget.limit = limit.value_or(0);
  budget.factor = factor.value_or(0);
  budget.plus = plus.value_or(0);
  budget.at_least = at_least.value_or(0);
  if (factor) {
    budget.bound = Bound::kMaxByReference;
    budget.reference = text_of(row, "reference", name);
  } else if (at_least) {
    budget.bound = Bound::kMin;
  }
  return budget;
}

}  // namespace

double Budget::allowed(double reference_figure) const {
  if (bound == Bound::kMaxByReference) return factor * reference_figure + plus;
  return bound == Bound::kMin ? at_least : limit;
}

bool Budget::is_kept(double figure, double reference_figure) const {
  const double border = allowed(reference_figure);
  return bound == Bound::kMin ? figure >= border : figure <= border;
}

Budget load_budget(const std::string& name, const std::string& file) {
  const toml::table table = read_table(file);
  const toml::table* const row = table[name].as_table();
  if (row == nullptr) {
    throw std::runtime_error("no budget " + name + " in " + (file.empty() ? "the table" : file));
  }
  return read_row(name, *row);
}

std::vector<Budget> load_budgets(const std::string& file) {
  std::vector<Budget> all;
  for (const auto& [key, row] : read_table(file)) {
    const std::string name(key.str());
    if (!row.is_table()) throw std::runtime_error("budget " + name + ": not a table");
    all.push_back(read_row(name, *row.as_table()));
  }
  return all;
}

std::string bound_text(const Budget& budget) {
  std::ostringstream text;
  text.precision(10);
  switch (budget.bound) {
    case Bound::kMax:
      text << "<= " << budget.limit << " " << budget.unit;
      break;
    case Bound::kMin:
      text << ">= " << budget.at_least << " " << budget.unit;
      break;
    case Bound::kMaxByReference:
      text << "<= ";
      if (budget.factor != 1) text << budget.factor << " x ";
      text << budget.reference;
      if (budget.plus != 0) text << " + " << budget.plus << " " << budget.unit;
      break;
  }
  return text.str();
}

std::string to_text(const Budget& budget, double reference_figure) {
  std::ostringstream text;
  text.precision(10);
  text << budget.what << ": " << budget.statistic << " "
       << (budget.bound == Bound::kMin ? ">= " : "<= ") << budget.allowed(reference_figure) << " "
       << budget.unit;
  if (budget.bound == Bound::kMaxByReference) {
    text << " (" << budget.factor << " x " << reference_figure << " + " << budget.plus << ")";
  }
  return text.str();
}

}  // namespace meridian::probe
