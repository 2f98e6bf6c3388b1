// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/programs/post/post_options.hpp"

namespace meridian::post {

/// A whole NC program and what there is to say about it.
struct NcProgram {
  std::string text;
  std::uint64_t blocks = 0;         ///< lines of the program
  std::uint64_t motion_blocks = 0;  ///< of the CL file
  std::uint64_t feeds_limited = 0;  ///< CL blocks above the machine's highest feed
};

/// Writes the NC program of the CL file behind `reader` for `model`, or says why there is none:
/// nothing is written in part, nothing is guessed. Branch, winding and poles as in the service.
/// `name` is what the header calls the file. Context: I/O. Proof: tests/unit/post,
/// tests/property/post. Source: docs/postprocessor.md.
[[nodiscard]] Expected<NcProgram, PostError> write_nc(cl::ClReader& reader, const std::string& name,
                                                      const MachineModel& model,
                                                      const ToolTable& tools,
                                                      const PostOptions& options);

}  // namespace meridian::post
