// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/homing_file.hpp"

#include <cmath>

namespace meridian::config {

HomingConfig read_homing(Section section, int joint_count) {
  HomingConfig homing;
  homing.timeout_s = section.number_or("timeout_s", homing.timeout_s, {0.1, 3600});
  if (section.has("order")) {
    const auto count = static_cast<std::size_t>(joint_count);
    const auto turns = section.numbers("order", count, count, {1, kMaxJoints},
                                       "give each joint, in machine order, the number of its turn");
    for (std::size_t i = 0; i < count; ++i) {
      if (turns[i] != std::floor(turns[i])) {
        section.refuse("order", "whole numbers from 1 on", "joints of one number home at once");
      }
      homing.turns[i] = static_cast<int>(turns[i]);
    }
  } else {
    (void)section.text_or("order", "");  // known, and not there
  }
  section.finish();
  return homing;
}

HomingConfig load_homing(const std::filesystem::path& path, int joint_count) {
  const toml::table table = parse_file(path);
  Section file(path.string(), table);
  return read_homing(file.section_or("homing"), joint_count);
}

}  // namespace meridian::config
