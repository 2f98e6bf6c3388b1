// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "support/text_file.hpp"

namespace meridian::test {

/// Expects that `document` holds `table` between its lines `<!-- NAME: begin -->` and
/// `<!-- NAME: end -->`. Run with MERIDIAN_REGENERATE=1 it writes the table there instead, for
/// review as a diff. Proof: tests/unit/support/document_table_test.cpp.
inline void expect_table_of_document(const std::filesystem::path& document, std::string_view name,
                                     const std::string& table) {
  const std::string begin_mark = "<!-- " + std::string(name) + ": begin -->\n";
  const std::string end_mark = "<!-- " + std::string(name) + ": end -->";
  std::string text = read_text(document);
  const std::size_t begin = text.find(begin_mark), end = text.find(end_mark);
  if (begin == std::string::npos || end == std::string::npos || end < begin + begin_mark.size()) {
    ADD_FAILURE() << document << " has no place for the table " << name;
    return;
  }
  const std::size_t first = begin + begin_mark.size();
  if (std::getenv("MERIDIAN_REGENERATE") == nullptr) {
    EXPECT_EQ(text.substr(first, end - first), table);
    return;
  }
  std::ofstream out(document, std::ios::binary);
  out << text.replace(first, end - first, table) << std::flush;
  EXPECT_TRUE(out) << document << " could not be written";
}

}  // namespace meridian::test
