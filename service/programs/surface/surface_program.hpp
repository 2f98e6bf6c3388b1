// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <string_view>
#include <vector>

#include "meridian/path/cl_block.hpp"
#include "service/programs/surface/patch_file.hpp"
#include "service/programs/surface/surface_path.hpp"

namespace meridian::surface {

/// The path as CL blocks: tool and spindle words where they are asked for, rapid to the clearance
/// above the first contact along its axis, plunge, lines and crossings at feed, rapid up, end. A
/// one-way path lifts by the clearance between lines. Proof:
/// tests/unit/surface/patch_file_test.cpp.
[[nodiscard]] std::vector<ClBlock> program_of(const PatchJob& job, const SurfacePath& path);

/// Writes them as an APT CL file; `source` stands in a comment. The same job gives the same bytes.
void write_program(const PatchJob& job, const SurfacePath& path, std::string_view source,
                   std::ostream& out);

}  // namespace meridian::surface
