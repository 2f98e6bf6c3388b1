// SPDX-License-Identifier: Apache-2.0
#include "fences/budget_fence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "service/host/probe/budgets.hpp"

namespace meridian::fences {
namespace {

std::vector<probe::Budget> project_budgets() {
  return probe::load_budgets(MERIDIAN_SOURCE_DIR "/deploy/budgets.toml");
}

TEST(BudgetFence, EveryRowOfTheTableHasAReader) {
  std::vector<SourceFile> sources;
  for (const char* const folder : {"service", "tests"}) {
    for (SourceFile& file : read_tree(MERIDIAN_SOURCE_DIR, folder, {".hpp", ".cpp"})) {
      if (!file.path.starts_with("tests/fences/")) sources.push_back(std::move(file));
    }
  }
  std::vector<std::string> names;
  for (const probe::Budget& budget : project_budgets()) names.push_back(budget.name);
  EXPECT_GT(names.size(), 40U);
  EXPECT_EQ(find_unread_budgets(names, sources), std::vector<std::string>{});
}

TEST(BudgetFence, TheDocsShowTheTableAsItIs) {
  std::vector<probe::Budget> left = project_budgets();
  std::erase_if(left, [](const auto& one) { return one.name.starts_with("instructions_"); });
  const auto rows = read_budget_rows(read_file(MERIDIAN_SOURCE_DIR, "docs/realtime.md"),
                                     "## The budgets, measured");
  for (const BudgetRow& row : rows) {
    SCOPED_TRACE(testing::Message() << "docs/realtime.md:" << row.line);
    ASSERT_EQ(row.names.size(), row.bounds.size());
    for (std::size_t i = 0; i < row.names.size(); ++i) {
      const auto budget = std::find_if(left.begin(), left.end(), [&](const probe::Budget& one) {
        return one.name == row.names[i];
      });
      ASSERT_NE(budget, left.end()) << row.names[i] << " is no budget, or is shown twice";
      EXPECT_EQ(row.bounds[i], bound_text(*budget)) << row.names[i];
      left.erase(budget);
    }
  }
  for (const probe::Budget& budget : left) {
    ADD_FAILURE() << "docs/realtime.md does not show " << budget.name;
  }
}

TEST(BudgetFence, CatchesARowThatNobodyReads) {
  const std::vector<SourceFile> sources{
      {"a.cpp", {"load_budget(\"read\")", "expect_within_budget(\"cycle\", 1)", "\"planner\""}}};
  EXPECT_EQ(
      find_unread_budgets({"read", "rea", "instructions_cycle", "instructions_planner"}, sources),
      (std::vector<std::string>{"rea", "instructions_planner"}));
}

TEST(BudgetFence, ReadsTheTableBehindItsHeading) {
  const SourceFile page{
      "a.md",
      {"| `not` | this |", "", "## Here", "words", "| what | budget |", "|---|---|",
       "| two: `one`, `other` | <= 1 us; >= 2 MiB | 3 |", "", "| `nor` | this |"}};
  const auto rows = read_budget_rows(page, "## Here");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].line, 7U);
  EXPECT_EQ(rows[0].names, (std::vector<std::string>{"one", "other"}));
  EXPECT_EQ(rows[0].bounds, (std::vector<std::string>{"<= 1 us", ">= 2 MiB"}));
}

}  // namespace
}  // namespace meridian::fences
