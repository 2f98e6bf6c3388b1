// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/file/section.hpp"

namespace meridian::config {

/// Joints of the machine under a name that operators say, such as where tools are changed.
struct NamedPosition {
  std::string name;
  JointVector joints{};
};

/// Reads every `[[position]]` of the machine file `file`, whose joints are those of `model`: name,
/// and joints in machine order, mm and deg, inside travel. Throws ConfigError.
/// Proof: tests/unit/machine_file/positions_file_test.cpp.
[[nodiscard]] std::vector<NamedPosition> read_positions(Section& file, const MachineModel& model);

/// The same from the text of a machine file that parse_machine() has taken; the first position is
/// `home`, that of the joints.
[[nodiscard]] std::vector<NamedPosition> parse_positions(std::string_view text,
                                                         const std::string& name);

/// By their names, every joint in machine order, mm and rad.
using PositionsByName = std::map<std::string, std::vector<double>>;
[[nodiscard]] PositionsByName positions_by_name(std::string_view text, const std::string& name);
/// The same of the machine file at `path`, which load_machine() has taken.
[[nodiscard]] PositionsByName load_positions(const std::filesystem::path& path);

}  // namespace meridian::config
