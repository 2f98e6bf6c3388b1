// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "meridian/cycle/state.hpp"
#include "service/protocol/operator/jog_hand.hpp"
#include "service/protocol/operator/operator_link.hpp"

namespace meridian::panel {

/// What a page says.
struct PageMessage {
  enum class Kind : std::uint8_t {
    kAsk,       ///< for `verb`
    kJog,       ///< a beat of grip `id`; the first one presses it
    kRelease,   ///< of grip `id`
    kTakeOver,  ///< this page is the operator's from now on
    kCheck,     ///< of the program, from `line` on
    kLoad,      ///< stream the program
    kUnload,    ///< end the stream
    kAnswer,    ///< to `action`: done or not
  };
  Kind kind = Kind::kAsk;
  std::uint64_t id = 0;  ///< of the answer, or of the grip
  Verb verb = Verb::kHold;
  double argument = 0;
  std::uint32_t line = 0;  ///< of kCheck; 0: the whole program
  std::uint64_t action = 0;
  bool is_done = false;
  stream::Seen seen{};
  stream::JogPlan plan{};
};

/// Returns what `text` says; nothing where it is anything else: no JSON, an unknown member or verb,
/// a number that is none, a joint that no machine has. Proof: tests/panel/operating_test.cpp.
[[nodiscard]] std::optional<PageMessage> read_page_message(std::string_view text);

}  // namespace meridian::panel
