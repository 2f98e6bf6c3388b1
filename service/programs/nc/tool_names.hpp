// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/programs/cl/refusal.hpp"

namespace meridian::nc {

/// Numbers of tools by their names in capitals, as a tool table has them.
using NamedTools = std::map<std::string, std::uint32_t>;

/// The tools that a program calls by name: those of the tool table, and for names that it has not
/// numbers beyond those of any magazine, in the order of the first call.
class ToolNames {
 public:
  static constexpr std::uint32_t kFirst = 900'000'001;
  static constexpr std::size_t kMax = 256;

  explicit ToolNames(NamedTools table) : table_(std::move(table)) {}

  /// What the tool table calls so.
  [[nodiscard]] std::optional<std::uint32_t> find(std::string_view name) const;
  /// The number of a name that the tool table has not, the next free one where it is new.
  [[nodiscard]] Expected<std::uint32_t, cl::Refusal> number_of(std::string_view name);

 private:
  NamedTools table_;
  std::vector<std::string> names_;
};

}  // namespace meridian::nc
