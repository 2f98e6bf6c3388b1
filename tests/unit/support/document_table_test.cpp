// SPDX-License-Identifier: Apache-2.0
#include "support/document_table.hpp"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "support/text_file.hpp"

namespace meridian::test::document_table {
namespace {

/// A document with two tables; whether tables are written is this test's word alone.
class DocumentTable : public testing::Test {
 protected:
  void SetUp() override {
    if (const char* const asked = std::getenv(kAsked)) asked_ = asked;
    ::unsetenv(kAsked);
  }
  void TearDown() override {
    if (asked_.empty()) {
      ::unsetenv(kAsked);
    } else {
      ::setenv(kAsked, asked_.c_str(), 1);
    }
  }
  [[nodiscard]] static std::string document_of(const std::string& second) {
    return "# Head\n<!-- a: begin -->\none\n<!-- a: end -->\n<!-- b: begin -->\n" + second +
           "<!-- b: end -->\nfoot\n";
  }

  static constexpr const char* kAsked = "MERIDIAN_REGENERATE";
  const TextFile document_{document_of("two\n"), ".md"};

 private:
  std::string asked_;
};

TEST_F(DocumentTable, IsComparedAndLeftAsItIs) {
  expect_table_of_document(document_.path(), "a", "one\n");
  expect_table_of_document(document_.path(), "b", "two\n");
  EXPECT_NONFATAL_FAILURE(expect_table_of_document(document_.path(), "b", "three\n"), "three");
  EXPECT_NONFATAL_FAILURE(expect_table_of_document(document_.path(), "b", ""), "two");
  EXPECT_EQ(read_text(document_.path()), document_of("two\n"));
}

TEST_F(DocumentTable, IsMissedWhereTheDocumentHasNoPlaceForIt) {
  const TextFile turned("<!-- a: end -->\n<!-- a: begin -->\n", ".md");
  EXPECT_NONFATAL_FAILURE(expect_table_of_document(document_.path(), "c", "one\n"), "no place");
  EXPECT_NONFATAL_FAILURE(expect_table_of_document(turned.path(), "a", ""), "no place");
  EXPECT_NONFATAL_FAILURE(expect_table_of_document("nowhere.md", "a", "one\n"), "no place");
}

TEST_F(DocumentTable, IsWrittenWhereTheEnvironmentAsksForIt) {
  ::setenv(kAsked, "1", 1);
  expect_table_of_document(document_.path(), "b", "three\nfour\n");
  EXPECT_EQ(read_text(document_.path()), document_of("three\nfour\n"));
}

}  // namespace
}  // namespace meridian::test::document_table
