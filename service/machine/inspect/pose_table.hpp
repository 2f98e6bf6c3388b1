// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/expected.hpp"
#include "service/machine/inspect/pose_solutions.hpp"

namespace meridian::inspect {

/// One row of a table of numbers, in the order of the columns that were asked for.
struct TableRow {
  std::uint32_t line = 0;
  std::vector<double> values;
};

/// Names of the columns of a pose: x_mm, y_mm, z_mm, i, j, k; and of the joints of a machine:
/// A_deg, X_mm.
[[nodiscard]] std::vector<std::string> pose_columns();
[[nodiscard]] std::vector<std::string> joint_columns(const MachineModel& model);

/// Reads rows of numbers parted by commas, semicolons, tabs or blanks; `#` begins a comment. A
/// first row of names says which column is which, and others are skipped; without one the columns
/// are those of `columns`, no more and no fewer. The error holds every line that cannot be read.
/// Context: I/O. Proof: tests/unit/inspect/pose_table_test.cpp.
[[nodiscard]] Expected<std::vector<TableRow>, std::string> read_table(
    std::istream& in, std::string_view name, const std::vector<std::string>& columns);

/// What became of a table: rows for people and programs, and how many poses no solution inside
/// travel reaches.
struct TableResult {
  std::string text;
  std::size_t unreached = 0;
};

/// Every solution of every pose as a table: its line, joints, drives of a stage, in how many
/// windings travel has it, the measure of singularity, the distance from the dead point, and what
/// is beyond travel. read_table() reads it back. Poses out of reach are comments. mm and deg.
[[nodiscard]] TableResult solve_table(const MachineModel& model,
                                      const std::vector<TableRow>& poses);
/// The pose of every row of joints, with the measure and what is beyond travel.
[[nodiscard]] TableResult pose_table(const MachineModel& model,
                                     const std::vector<TableRow>& joints);

/// The same two as one JSON array.
[[nodiscard]] TableResult solve_table_json(const MachineModel& model,
                                           const std::vector<TableRow>& poses);
[[nodiscard]] TableResult pose_table_json(const MachineModel& model,
                                          const std::vector<TableRow>& joints);

}  // namespace meridian::inspect
