// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "service/host/probe/budgets.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::panel {

/// The table of budgets; empty where this host has none.
[[nodiscard]] std::vector<probe::Budget> known_budgets();

/// {"t":"latency", "stages": [...]}: of every stage name, count, percentiles and maximum in µs, its
/// distribution in four bins an octave from `first_us` on, and its budgets: what each allows and,
/// where that is a time, the figure that is held against it. A budget by comparison has words
/// alone: `meridian probe` measures what it is compared with.
/// Proof: tests/panel/latency_text_test.cpp.
[[nodiscard]] std::string latency_text(const dds::Latency& latency, std::int64_t cycle_ns,
                                       const std::vector<probe::Budget>& budgets);

}  // namespace meridian::panel
