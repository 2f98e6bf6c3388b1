// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "meridian/path/cl_block.hpp"
#include "service/cl/cl_options.hpp"

namespace meridian::cl {

/// What was read so far. Units: mm, rad, s; frame: W. Bounded, whatever the length of the file.
struct ClSummary {
  static constexpr std::size_t kMostTools = 64;

  std::string dialect = "APT";
  std::string program;  ///< PARTNO or the first TOOL PATH
  std::uint64_t bytes = 0;
  std::uint64_t lines = 0;
  std::uint64_t statements = 0;
  std::uint64_t comments = 0;
  std::uint64_t blocks = 0;
  std::array<std::uint64_t, 8> blocks_by_kind{};  ///< index: BlockKind
  std::uint64_t goto_three = 0;                   ///< GOTO with position alone
  std::uint64_t goto_six = 0;                     ///< GOTO with position and tool axis
  std::uint64_t arcs = 0;
  std::uint64_t full_circles = 0;
  std::uint64_t zero_length = 0;    ///< motion blocks that neither move the tip nor turn the axis
  std::uint64_t display_words = 0;  ///< skipped
  std::uint64_t frame_changes = 0;  ///< after motion had begun
  std::uint64_t feeds_limited = 0;  ///< blocks above the machine's maximum feed
  LengthUnit unit = LengthUnit::kMillimetre;
  Array3 box_min_mm{kInfinity, kInfinity, kInfinity};  ///< of all GOTO points
  Array3 box_max_mm{-kInfinity, -kInfinity, -kInfinity};
  double tilt_min_rad = kInfinity;  ///< angle of the tool axis from +z of W
  double tilt_max_rad = 0;
  double axis_change_max_rad = 0;  ///< largest in one block
  double feed_min_mm_per_s = kInfinity;
  double feed_max_mm_per_s = 0;
  double cut_length_mm = 0;
  double rapid_length_mm = 0;
  double cut_time_s = 0;  ///< at the programmed feed
  double dwell_time_s = 0;
  double arc_mismatch_max_mm = 0;
  std::vector<std::uint32_t> tools;  ///< numbers loaded, in order of first use, at most kMostTools

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
};

/// The summary as lines for a person.
[[nodiscard]] std::string to_text(const ClSummary& summary);

}  // namespace meridian::cl
