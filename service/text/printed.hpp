// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

/// Reports for people and programs, put together from printf formats.
namespace meridian::text {

/// What printf's %llu calls std::uint64_t.
using Count = unsigned long long;

/// What std::printf prints.
[[nodiscard, gnu::format(printf, 1, 2)]] std::string printed(const char* format, ...);

/// Adds `format` with its arguments to `text`.
[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...);

/// `text` as a JSON string, its quotes included.
[[nodiscard]] std::string json_quoted(const std::string& text);

/// `value` as `format`, one conversion of a double, prints it; null where it is no finite number,
/// which JSON cannot say.
[[nodiscard]] std::string json_number(const char* format, double value);

}  // namespace meridian::text
