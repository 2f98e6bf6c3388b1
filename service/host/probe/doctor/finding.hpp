// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace meridian::probe {

enum class Health : std::uint8_t {
  kFine,
  kNote,  ///< costs latency or certainty; a machine may run so
  kBad    ///< real time cannot be kept here
};

/// One thing looked at on a host.
struct Finding {
  std::string what;  ///< "real-time priority"
  Health health = Health::kFine;
  std::string found;   ///< what there is
  std::string remedy;  ///< what to do about it; empty where all is well
};
using Findings = std::vector<Finding>;

/// A line per finding with its remedy below, and the verdict.
[[nodiscard]] std::string to_text(const Findings& findings);
[[nodiscard]] std::string to_json(const Findings& findings);
/// Whether nothing is bad.
[[nodiscard]] bool is_fit(const Findings& findings) noexcept;

}  // namespace meridian::probe
