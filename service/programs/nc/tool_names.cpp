// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/tool_names.hpp"

#include <algorithm>

namespace meridian::nc {

std::optional<std::uint32_t> ToolNames::find(std::string_view name) const {
  const auto at = table_.find(std::string(name));
  return at == table_.end() ? std::nullopt : std::optional<std::uint32_t>(at->second);
}

Expected<std::uint32_t, cl::Refusal> ToolNames::number_of(std::string_view name) {
  const auto at = std::find(names_.begin(), names_.end(), name);
  const auto index = static_cast<std::uint32_t>(at - names_.begin());
  if (at == names_.end()) {
    if (names_.size() == kMax) {
      return cl::refuse("more than " + std::to_string(kMax) + " names of tools",
                        "name them in the tool table");
    }
    names_.emplace_back(name);
  }
  return kFirst + index;
}

}  // namespace meridian::nc
