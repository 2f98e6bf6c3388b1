// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace meridian::panel {

/// What came of what an operator asked for.
struct Outcome {
  bool is_accepted = false;
  std::string text;
};
using OnOutcome = std::function<void(const Outcome&)>;

}  // namespace meridian::panel
