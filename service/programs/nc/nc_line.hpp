// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "service/programs/cl/refusal.hpp"

namespace meridian::nc {

/// An address with its number, G43.4, C1=90.
struct Word {
  enum class DistanceMode : std::uint8_t {
    kModal,
    kAbsolute,     ///< AC of Siemens
    kIncremental,  ///< IC of Siemens, IX of Klartext
    kShortest,     ///< DC of Siemens: to this angle within a turn, through less than half a turn
    kUpwards,      ///< ACP of Siemens: to this angle within a turn, in the positive sense
    kDownwards,    ///< ACN of Siemens: the same in the negative sense
    kOfPlane       ///< Q120 to Q122 of Klartext: what the tilted plane asks of a rotary axis
  };

  std::string_view address;  ///< in capitals; more than one sign only before a `=`
  std::string_view digits;   ///< the number as written
  std::string_view text;     ///< T="MILL": a name where a number stands elsewhere, in capitals
  double number = 0;
  bool has_point = false;
  std::uint8_t decimals = 0;
  DistanceMode distance_mode = DistanceMode::kModal;

  [[nodiscard]] bool is(char letter) const noexcept {
    return address.size() == 1 && address.front() == letter;
  }
  /// Whether a rotary axis may be called so.
  [[nodiscard]] bool may_be_rotary() const noexcept;
};

/// One line of an NC program, cut into words. Views are good until the next line is cut.
struct Line {
  std::uint32_t number = 0;       ///< of the file
  bool is_tape_mark = false;      ///< `%`
  bool has_block_delete = false;  ///< `/` before its words
  std::vector<Word> words;        ///< without N
  /// A word of more letters, and what stands in brackets behind it: Siemens alone.
  struct Name {
    std::string_view name, arguments;
  };
  std::vector<Name> names;
  std::string_view comment;  ///< the first one
  std::uint64_t comments = 0;

  /// The only word of this address; null where there is none.
  [[nodiscard]] const Word* find(std::string_view address) const noexcept;

  /// Takes the text of the next line, and nothing else is known of it.
  void begin(std::string_view line, std::uint32_t at);

  std::string text;  ///< in capitals; what the views look at
};

/// Cuts `text` into `line`. Comments stand in brackets or behind `;`. Refused by name: variables,
/// expressions, words of macros and jumps, and addresses twice (but G and M). Whatever is refused,
/// nothing of the line may be used. Proof: tests/unit/nc/line_test.cpp.
[[nodiscard]] cl::Outcome cut(std::string_view text, std::uint32_t number, Line& line);

}  // namespace meridian::nc
