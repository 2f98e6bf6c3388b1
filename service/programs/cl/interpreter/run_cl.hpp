// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <ostream>
#include <string>

#include "service/programs/cl/cl_options.hpp"
#include "service/programs/cl/cl_points.hpp"

namespace meridian::cl {

/// What `meridian cl` is asked for.
struct RunOptions {
  std::string file;    ///< "-": standard input
  std::string output;  ///< empty: standard output
  enum class Output : std::uint8_t { kPoints, kSummary, kJson };
  Output what = Output::kPoints;
  double chord_error_mm = kChordError_mm;
  ClReaderOptions reader;
};

/// Writes the plain path of a CL file, one point a line: `x y z i j k feed`, mm and mm/min, with
/// all digits that a double has; feed is that of the block that ends there, 0 for rapid; arcs as
/// chords; or a summary. Everything that is found in the file goes to `err`, by line, in one pass;
/// as JSON it is part of the output. An output file of a refused input is removed. Returns the exit
/// code of the tool: 0 fine, 3 input refused.
int run_cl(const RunOptions& options, std::ostream& out, std::ostream& err);

}  // namespace meridian::cl
