// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "meridian/expected.hpp"

namespace meridian::cl {

/// Why a statement is refused. What reads the statement names file and line.
struct Refusal {
  std::string message;
  std::string remedy;      ///< empty where the line has to be written in another form
  std::string group;       ///< refusals of one group are alike; empty: the message without numbers
  std::uint32_t line = 0;  ///< where another line than that of the statement is at fault
};

using Outcome = Expected<void, Refusal>;

[[nodiscard]] inline tl::unexpected<Refusal> refuse(std::string message, std::string remedy = {},
                                                    std::string group = {}) {
  return tl::make_unexpected(Refusal{std::move(message), std::move(remedy), std::move(group), 0});
}

/// The same, at another line than that of the statement.
[[nodiscard]] inline tl::unexpected<Refusal> refuse_at(std::uint32_t line, std::string message,
                                                       std::string remedy = {}) {
  return tl::make_unexpected(Refusal{std::move(message), std::move(remedy), {}, line});
}

}  // namespace meridian::cl
