// SPDX-License-Identifier: Apache-2.0
#include "service/probe/budgets.hpp"

#include <toml++/toml.h>

#include <sstream>
#include <stdexcept>

#include "service/process/programs.hpp"

namespace meridian::probe {
namespace {

std::string text_of(const toml::table& row, const char* key, const std::string& name) {
  const auto text = row[key].value<std::string>();
  if (!text) {
    throw std::runtime_error("budget " + name + ": no " + key);
  }
  return *text;
}

}  // namespace

Budget load_budget(const std::string& name, const std::string& file) {
  const toml::table table =
      toml::parse_file(file.empty() ? process::shipped_file("budgets.toml").string() : file);
  const toml::table* const row = table[name].as_table();
  if (row == nullptr) {
    throw std::runtime_error("no budget " + name + " in " + file);
  }
  Budget budget;
  budget.name = name;
  budget.what = text_of(*row, "what", name);
  budget.statistic = text_of(*row, "statistic", name);
  budget.unit = text_of(*row, "unit", name);
  budget.judged = text_of(*row, "judged", name);
  const auto limit = (*row)["limit"].value<double>();
  const auto factor = (*row)["factor"].value<double>();
  const auto plus = (*row)["plus"].value<double>();
  const auto at_least = (*row)["at_least"].value<double>();
  if (int{limit.has_value()} + int{factor.has_value()} + int{at_least.has_value()} != 1 ||
      factor.has_value() != plus.has_value()) {
    throw std::runtime_error("budget " + name + ": wants one of limit, factor with plus, at_least");
  }
  budget.limit = limit.value_or(0);
  budget.factor = factor.value_or(0);
  budget.plus = plus.value_or(0);
  budget.at_least = at_least.value_or(0);
  budget.is_relative = factor.has_value();
  if (budget.is_relative) {
    budget.reference = text_of(*row, "reference", name);
  }
  return budget;
}

std::string to_text(const Budget& budget, double reference_figure) {
  std::ostringstream text;
  text << budget.what << ": " << budget.statistic;
  if (budget.is_relative) {
    text << " <= " << budget.allowed(reference_figure) << " " << budget.unit << " ("
         << budget.factor << " x " << reference_figure << " + " << budget.plus << ")";
  } else if (budget.at_least > 0) {
    text << " >= " << budget.at_least << " " << budget.unit;
  } else {
    text << " <= " << budget.limit << " " << budget.unit;
  }
  return text.str();
}

}  // namespace meridian::probe
