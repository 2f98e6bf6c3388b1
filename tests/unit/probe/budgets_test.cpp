// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/budgets.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace meridian::probe {
namespace {

/// A table in a file that is gone with the test.
class TableFile {
 public:
  explicit TableFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("meridian_budgets_" + std::to_string(getpid()) + ".toml")) {
    std::ofstream(path_) << text;
  }
  TableFile(const TableFile&) = delete;
  TableFile& operator=(const TableFile&) = delete;
  ~TableFile() { std::filesystem::remove(path_); }
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

constexpr char kHead[] = "[a]\nwhat=\"w\"\nstatistic=\"p99\"\nunit=\"us\"\nchecked=\"j\"\n";

TEST(Budgets, AnAbsoluteOneIsItsLimit) {
  const TableFile file(std::string(kHead) + "limit = 60\n");
  EXPECT_EQ(load_budget("a", file.path()).allowed(), 60);
}

TEST(Budgets, ARelativeOneFollowsItsReference) {
  const TableFile file(std::string(kHead) + "factor = 1.5\nplus = 20\nreference = \"bare\"\n");
  EXPECT_EQ(load_budget("a", file.path()).allowed(100), 170);
}

TEST(Budgets, RefusesARowThatIsNotWhole) {
  for (const char* const rest :
       {"", "limit = 1\nat_least = 1\n", "limit = 1\nfactor = 2\nplus = 0\nreference = \"r\"\n",
        "factor = 2\nreference = \"r\"\n", "factor = 2\nplus = 0\n"}) {
    const TableFile file(std::string(kHead) + rest);
    EXPECT_THROW((void)load_budget("a", file.path()), std::runtime_error) << rest;
  }
}

TEST(Budgets, RefusesANameThatIsNotInTheTable) {
  EXPECT_THROW((void)load_budget("no_such_budget"), std::runtime_error);
}

TEST(Budgets, OneFromBelowIsKeptByWhatIsNotBelow) {
  const TableFile file(std::string(kHead) + "at_least = 50\n");
  const Budget budget = load_budget("a", file.path());
  EXPECT_EQ(budget.bound, Bound::kMin);
  EXPECT_EQ(budget.allowed(), 50);
  EXPECT_TRUE(budget.is_kept(50));
  EXPECT_TRUE(budget.is_kept(1000));
  EXPECT_FALSE(budget.is_kept(49));
  EXPECT_FALSE(budget.is_kept(0));
  EXPECT_EQ(bound_text(budget), ">= 50 us");
  EXPECT_EQ(to_text(budget), "w: p99 >= 50 us");
}

TEST(Budgets, OnesFromAboveAreKeptByWhatIsNotAbove) {
  const TableFile absolute(std::string(kHead) + "limit = 60\n");
  EXPECT_TRUE(load_budget("a", absolute.path()).is_kept(60));
  EXPECT_FALSE(load_budget("a", absolute.path()).is_kept(61));
  EXPECT_FALSE(load_budget("a", absolute.path()).is_kept(std::nan("")));
  EXPECT_EQ(bound_text(load_budget("a", absolute.path())), "<= 60 us");
  const TableFile relative(std::string(kHead) + "factor = 1\nplus = 40\nreference = \"bare\"\n");
  EXPECT_TRUE(load_budget("a", relative.path()).is_kept(140, 100));
  EXPECT_FALSE(load_budget("a", relative.path()).is_kept(141, 100));
  EXPECT_EQ(bound_text(load_budget("a", relative.path())), "<= bare + 40 us");
}

TEST(Budgets, EveryRowOfTheProjectsTableIsWhole) {
  const std::vector<Budget> all = load_budgets();
  EXPECT_GT(all.size(), 40U);
  for (const Budget& budget : all) {
    EXPECT_TRUE(std::isfinite(budget.allowed(1))) << budget.name;
    EXPECT_FALSE(budget.unit.empty() || budget.checked.empty()) << budget.name;
  }
}

}  // namespace
}  // namespace meridian::probe
