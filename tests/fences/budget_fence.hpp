// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "fences/source_tree.hpp"

/// One table of budgets: every row has a reader, and the docs show it as it is.
namespace meridian::fences {

/// The rows of deploy/budgets.toml that no source names in quotes; of the instruction counts, that
/// no gate names.
[[nodiscard]] std::vector<std::string> find_unread_budgets(const std::vector<std::string>& rows,
                                                           const std::vector<SourceFile>& sources);

/// A row of the table of budgets in the docs: the budgets that its first cell names in backticks,
/// and what its second cell says of them, in the same order.
struct BudgetRow {
  std::size_t line = 0;
  std::vector<std::string> names, bounds;
};

/// The rows of the first table behind the line that starts with `heading`; bounds are separated by
/// semicolons.
[[nodiscard]] std::vector<BudgetRow> read_budget_rows(const SourceFile& page,
                                                      const std::string& heading);

}  // namespace meridian::fences
