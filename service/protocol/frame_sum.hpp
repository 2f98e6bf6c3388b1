// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/work_frame.hpp"
#include "service/text/checksum.hpp"

namespace meridian::stream {

/// By which station and service know that they mean the same work frames: FNV-1a, 64 bit, of the
/// one in force, its rotation row by row and its origin, as they lie in memory, and of the rows of
/// the table, which NC programs may call, but for their names. Never 0. Proof:
/// tests/unit/protocol/frame_sum_test.cpp.
[[nodiscard]] inline std::uint64_t frame_sum(const std::array<double, 9>& rotation,
                                             const Array3& origin_mm,
                                             std::span<const WorkFrame> rows) noexcept {
  text::Checksum sum;
  for (const double value : rotation) sum.add(value);
  for (const double value : origin_mm) sum.add(value);
  for (const WorkFrame& row : rows) {
    sum.add(static_cast<double>(row.number));
    for (const double value : row.origin_mm) sum.add(value);
    for (const double value : row.rotation_deg) sum.add(value);
  }
  return sum.sum();
}

/// A rotation row by row, as it travels.
[[nodiscard]] inline std::array<double, 9> rows_of(const Eigen::Matrix3d& rotation) noexcept {
  std::array<double, 9> rows{};
  for (int i = 0; i < 9; ++i) rows[static_cast<std::size_t>(i)] = rotation(i / 3, i % 3);
  return rows;
}

[[nodiscard]] inline std::uint64_t frame_sum(const MachineModel& model,
                                             std::span<const WorkFrame> rows) noexcept {
  return frame_sum(rows_of(model.X_MW.rotation), to_array(model.X_MW.origin_mm), rows);
}

/// The inverse of rows_of() and to_array(): puts the workpiece of `model` there, bit for bit.
inline void place_frame(MachineModel& model, const std::array<double, 9>& rows,
                        const Array3& origin_mm) noexcept {
  for (int i = 0; i < 9; ++i) {
    model.X_MW.rotation(i / 3, i % 3) = rows[static_cast<std::size_t>(i)];
  }
  model.X_MW.origin_mm = to_vector(origin_mm);
}

}  // namespace meridian::stream
