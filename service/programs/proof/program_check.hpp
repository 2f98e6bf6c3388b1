// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "meridian/kinematics/tool_table.hpp"
#include "meridian/path/cl_block.hpp"
#include "service/programs/proof/joint_program.hpp"

namespace meridian::proof {

/// Tolerances from the CL path; 0: the machine's. Units: mm, rad.
struct ProgramCheckOptions {
  double tip_mm = 0;
  double axis_rad = 0;
};

/// The largest deviation and the line of the program where it is.
struct ProgramPeak {
  double value = 0;
  std::uint32_t line = 0;
};

/// Why the program does not cut the part.
struct ProgramFinding {
  std::string text;
  std::uint32_t line = 0;     ///< of the program; 0: of none
  std::uint32_t cl_line = 0;  ///< of the CL file; 0: of none
};

/// Units: mm, rad.
struct ProgramReport {
  std::string program, path_name;
  double tip_tolerance_mm = 0, axis_tolerance_rad = 0;
  std::uint64_t moves = 0;     ///< of the program, on the path
  std::uint64_t motions = 0;   ///< of the CL file
  std::uint64_t sections = 0;  ///< from one tool change to the next
  std::uint64_t rewinds =
      0;  ///< off the part and back to the same position, one turn or more farther
  double tip_length_mm = 0;
  ProgramPeak tip_mm, axis_rad;
  std::vector<ProgramFinding> findings;

  [[nodiscard]] bool passed() const noexcept { return findings.empty(); }
};

/// Runs `steps` as their control would, every drive evenly from line to line, through forward
/// kinematics, or the tip as its program of tool-centre words gives it, and holds tip and axis
/// against `blocks`, a whole CL file.
///
/// Tool by tool: from the first line that ends on the first CL point to the last that ends on the
/// last one there has to be a monotone matching of tool and path within both tolerances, in which
/// every CL point is passed in its order (record::PathMatching). Before and behind there may be
/// rapids, and before the first point cuts too: the approach. A rewind of the redundant joint off
/// the part (find_rewind) is no part of the path. Feeds are not looked at; a rapid is taken as
/// straight in the drives. Context: I/O. Proof: tests/unit/proof.
[[nodiscard]] ProgramReport check_program(const std::vector<ProgramStep>& steps,
                                          const std::vector<ClBlock>& blocks,
                                          const MachineModel& model, const ToolTable& tools,
                                          const ProgramCheckOptions& options);

/// The report for a person, ending in PASS or FAIL; the same as one JSON object.
[[nodiscard]] std::string to_text(const ProgramReport& report);
[[nodiscard]] std::string to_json(const ProgramReport& report);

}  // namespace meridian::proof
