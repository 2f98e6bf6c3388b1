// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "service/machine/file/machine_file.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/programs/post/post.hpp"

namespace meridian::test {

[[nodiscard]] inline MachineModel shipped(const std::string& name) {
  return config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/" + name + ".toml");
}

/// The NC program of a CL text, or why there is none.
[[nodiscard]] inline Expected<post::NcProgram, post::PostError> written(
    std::string_view text, const MachineModel& model, const post::PostOptions& options = {},
    const std::string& name = "part.apt") {
  cl::ClReader reader(text, name);
  const ToolTable tools({{1, model.tool_length_mm, 5}, {2, model.tool_length_mm + 20, 5}});
  return post::write_nc(reader, name, model, tools, options);
}

/// A program with `middle` between its first point and its end.
[[nodiscard]] inline std::string program_with(const std::string& middle) {
  std::string text = "UNITS/MM\nMULTAX/ON\nFEDRAT/600,MMPM\nGOTO/100,0,0,0,0,1\n";
  return text.append(middle).append("FINI\n");
}

}  // namespace meridian::test
