// SPDX-License-Identifier: Apache-2.0
#include "service/probe/budgets.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

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

constexpr char kHead[] = "[a]\nwhat=\"w\"\nstatistic=\"p99\"\nunit=\"us\"\njudged=\"j\"\n";

TEST(Budgets, AnAbsoluteOneIsItsLimit) {
  const TableFile file(std::string(kHead) + "limit = 60\n");
  EXPECT_EQ(load_budget("a", file.path()).allowed(), 60);
}

TEST(Budgets, ARelativeOneFollowsItsReference) {
  const TableFile file(std::string(kHead) + "factor = 1.5\nplus = 20\nreference = \"bare\"\n");
  EXPECT_EQ(load_budget("a", file.path()).allowed(100), 170);
}

TEST(Budgets, RefusesARowThatIsNotWhole) {
  for (const char* const rest : {"", "limit = 1\nfactor = 2\nplus = 0\nreference = \"r\"\n",
                                 "factor = 2\nreference = \"r\"\n", "factor = 2\nplus = 0\n"}) {
    const TableFile file(std::string(kHead) + rest);
    EXPECT_THROW((void)load_budget("a", file.path()), std::runtime_error) << rest;
  }
}

TEST(Budgets, RefusesANameThatIsNotInTheTable) {
  EXPECT_THROW((void)load_budget("no_such_budget"), std::runtime_error);
}

TEST(Budgets, TheProjectsTableHoldsTheLatencyGates) {
  const Budget lateness = load_budget("cycle_lateness");
  EXPECT_EQ(lateness.factor, 1.5);
  EXPECT_EQ(lateness.plus, 20);
  EXPECT_EQ(load_budget("setpoint_latency_p99").allowed(100), 250);
}

}  // namespace
}  // namespace meridian::probe
