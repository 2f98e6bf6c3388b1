// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace meridian::test {

/// Files beside the project that tests read where they are there and skip by name where not (CMake
/// variable MERIDIAN_SHARED_DIR): CL files of real CAM systems, benchmark paths, golden tables, the
/// outside checker of recordings.
[[nodiscard]] inline std::filesystem::path shared_folder() { return MERIDIAN_SHARED_DIR; }

}  // namespace meridian::test
