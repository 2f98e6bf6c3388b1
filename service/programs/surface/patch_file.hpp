// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "service/programs/surface/shape/contact.hpp"
#include "service/programs/surface/shape/nurbs_surface.hpp"
#include "service/programs/surface/surface_path.hpp"

namespace meridian::surface {

/// What goes around the path in the CL file. Units: mm, mm/s, rev/min.
struct PatchProgram {
  double feed_mm_per_s = 0;
  double plunge_feed_mm_per_s = 0;
  double clearance_mm = 0;
  double spindle_rpm = 0;  ///< 0: no spindle word
  int tool_number = 0;     ///< 0: no tool word
};

/// A patch with the cutter and the path that are asked for; `rule.surface` is `surface`.
struct PatchJob {
  std::string name;
  std::shared_ptr<const NurbsSurface> surface;
  ContactRule rule;
  CoverOptions cover;
  PatchProgram program;
};

/// Reads a patch file (docs/surface.md, chapter 4). Throws config::ConfigError, which names file,
/// line, key, value, what is allowed and the remedy. Proof: tests/unit/surface/patch_file_test.cpp.
[[nodiscard]] PatchJob load_patch(const std::filesystem::path& path);

/// The same for text; `name` is what messages call it.
[[nodiscard]] PatchJob parse_patch(std::string_view text, const std::string& name);

}  // namespace meridian::surface
