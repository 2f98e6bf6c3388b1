// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "service/recording/record/check/check_report.hpp"
#include "service/recording/record/check/path/checked_path.hpp"
#include "service/recording/record/check/path/path_matching.hpp"

namespace meridian::record {

/// Counts the CL vertices that were passed and those that were missed. Units: mm, rad.
class VertexCheck {
 public:
  VertexCheck(const CheckedPath& path, double tip_tolerance_mm)
      : path_(path), tip_tolerance_(tip_tolerance_mm) {}

  /// Vertices that were left.
  void add(std::span<const VertexPass> passes);
  /// After the last row: of those that were not left the ones that were passed, in order.
  void add_last(std::span<const VertexPass> passes);
  void finish(CheckReport& report) const;

 private:
  void add(const VertexPass& pass);
  [[nodiscard]] std::uint32_t line_of(std::size_t index) const noexcept;

  const CheckedPath& path_;
  double tip_tolerance_;
  Peak farthest_;
  Excess missed_, unturned_;
  std::uint64_t count_ = 0, in_gaps_ = 0;
};

}  // namespace meridian::record
