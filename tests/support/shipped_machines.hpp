// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace meridian::test {

/// Where the machine files that ship are.
inline const std::filesystem::path kMachineFolder = MERIDIAN_SOURCE_DIR "/deploy/machines";

[[nodiscard]] inline std::filesystem::path shipped_file(const std::string& machine) {
  return kMachineFolder / (machine + ".toml");
}

/// Their names, in order of the alphabet.
[[nodiscard]] inline std::vector<std::string> shipped_machines() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kMachineFolder)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Names a parametrised test after its machine.
[[nodiscard]] inline std::string test_name(const testing::TestParamInfo<std::string>& machine) {
  std::string name = machine.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace meridian::test
