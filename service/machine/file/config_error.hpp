// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace meridian::config {

/// What is wrong with a file, so that its author can mend it without reading our source. `value` is
/// empty where a key is missing, `key` where the file is not TOML at all.
struct ConfigFault {
  std::string file{};
  int line = 0;           ///< 1-based; 0: the file as a whole
  std::string key{};      ///< full name, such as joints.b3.velocity_mm_per_s
  std::string value{};    ///< as written in the file
  std::string allowed{};  ///< what would be right, with its unit
  std::string remedy{};   ///< what to do
};

/// The only exception of this room. what() is one line:
/// `FILE:LINE: KEY = VALUE is refused; allowed: RANGE; remedy: WHAT TO DO`.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(ConfigFault fault);

  [[nodiscard]] const ConfigFault& fault() const noexcept { return fault_; }

 private:
  ConfigFault fault_;
};

}  // namespace meridian::config
