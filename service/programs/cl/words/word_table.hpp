// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "service/programs/cl/dialect.hpp"
#include "service/programs/cl/words/handlers.hpp"

namespace meridian::cl {

enum class WordClass : std::uint8_t {
  kMoves,
  kMeaning,  ///< changes what motion means
  kMachine,  ///< a function of the machine
  kHarmless  ///< cannot carry motion
};

/// Where a word may stand.
enum class Standing : std::uint8_t {
  kAnywhere,
  kOutsideCurves,  ///< not between a CIRCLE or NURBS and what ends it
  kInLists,        ///< anywhere, and a bare list of points, which promises no end, may have it
  kListsOutsideCurves
};

/// One row of the table of words. A prefix (CSI_) ends in an underscore.
struct WordRow {
  std::string_view word;
  WordClass what;
  std::string_view forms;  ///< as written, without the word: "/x,y,z[,i,j,k]"
  Handler handler;
  std::string_view note = {};  ///< why it is refused, or what is remarked when it is skipped
  Standing standing = Standing::kAnywhere;
  Dialect shows = Dialect::kUnknown;  ///< whose files alone have it
};

/// All words, in the order of their letters.
[[nodiscard]] std::span<const WordRow> word_rows();

/// The row of a major word, given in capitals; null where nobody knows it.
[[nodiscard]] const WordRow* find_word(std::string_view major) noexcept;

/// The table as text: word, class and forms, a row each.
[[nodiscard]] std::string words_text();

}  // namespace meridian::cl
