// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "meridian/rt/state.hpp"
#include "service/stream/jog_hand.hpp"
#include "service/stream/operator_link.hpp"

namespace meridian::panel {

/// What a page says.
struct PageMessage {
  enum class Kind : std::uint8_t {
    kAsk,       ///< for `verb`
    kJog,       ///< a beat of grip `id`; the first one presses it
    kRelease,   ///< of grip `id`
    kTakeOver,  ///< this page is the operator's from now on
  };
  Kind kind = Kind::kAsk;
  std::uint64_t id = 0;  ///< of the answer, or of the grip
  Verb verb = Verb::kHold;
  double argument = 0;
  stream::Seen seen{};
  stream::JogPlan plan{};
};

/// Returns what `text` says; nothing where it is anything else: no JSON, an unknown member or verb,
/// a number that is none, a joint that no machine has. Proof: tests/panel/operating_test.cpp.
[[nodiscard]] std::optional<PageMessage> read_page_message(std::string_view text);

}  // namespace meridian::panel
