// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/file/section.hpp"

namespace meridian::config {

/// A body of the machine or of the part, for pictures alone: nothing is moved or checked by it.
struct Mesh {
  std::string link;  ///< "base", a joint's name, or "part"
  std::string file;  ///< plain name of an STL file, millimetre
};

inline constexpr std::size_t kMaxMeshes = 32;

/// The meshes of a machine file, [[mesh]], in its order. Throws ConfigError.
/// Proof: tests/unit/machine_file/mesh_file_test.cpp.
[[nodiscard]] std::vector<Mesh> read_meshes(Section& file, const MachineModel& model);
/// The same for the text of a whole machine file that `model` was read from.
[[nodiscard]] std::vector<Mesh> parse_meshes(std::string_view text, const std::string& name,
                                             const MachineModel& model);

}  // namespace meridian::config
