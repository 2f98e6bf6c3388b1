// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/cl_block.hpp"
#include "service/analysis/simulate/held_by.hpp"

namespace meridian::simulate {

/// Where the time of one block went. Units: s, mm, rad.
struct ExplainedBlock {
  std::uint64_t sequence = 0;
  std::uint32_t line = 0;
  BlockKind kind = BlockKind::kCut;
  bool is_above_machine_feed = false;
  double length_mm = 0;            ///< of the programmed path of the tip
  double programmed_mm_per_s = 0;  ///< tip feed; 0: none, or the tip rests
  double time_s = 0;               ///< taken
  double lost_s = 0;               ///< of it: more than the programmed feed takes; cuts alone
  double distance_mm = 0;          ///< of the tip in that time
  double min_mm_per_s = 0;         ///< slowest cycle; blocks shorter than one have their mean
  double relaxed_rad = 0;          ///< beside the pole, largest
  std::array<float, kLimitIds> by_limit{};  ///< s of time at each limit
  std::array<float, kCauses> by_cause{};
  std::array<float, kLimitIds> lost_by_limit{};
  std::array<float, kCauses> lost_by_cause{};

  [[nodiscard]] double mean_mm_per_s() const noexcept {
    return time_s > 0 ? distance_mm / time_s : 0;
  }
  /// What cost most; where nothing was lost, what held longest.
  [[nodiscard]] LimitId main_limit() const noexcept;
  [[nodiscard]] Cause main_cause() const noexcept;
};

/// Blocks one after the other that the same limit held for the same cause.
struct ExplainedStretch {
  std::uint32_t first_line = 0, last_line = 0;
  std::uint64_t blocks = 0;
  LimitId limit = kNoLimit;
  Cause cause = Cause::kPath;
  double time_s = 0, lost_s = 0, distance_mm = 0;
  double programmed_mm_per_s = 0;  ///< largest
  double min_mm_per_s = 0;
};

/// Where the time of a program went.
struct Explanation {
  struct Share {
    double time_s = 0, lost_s = 0;
  };
  std::uint64_t blocks = 0, cycles = 0;
  double time_s = 0;
  double lost_s = 0;
  std::array<std::array<Share, kCauses>, kLimitIds> shares{};
  std::vector<ExplainedStretch> worst;  ///< most lost first, at most kMaxStretches
  static constexpr std::size_t kMaxStretches = 15;
};

/// Tables for a person: time by limit and cause, then the stretches that cost most.
[[nodiscard]] std::string to_text(const Explanation& explanation, const MachineModel& model);

/// The table of all blocks as CSV: header, and one row. Feeds in mm/min.
[[nodiscard]] std::string explained_header(const MachineModel& model);
[[nodiscard]] std::string to_csv(const ExplainedBlock& block, const MachineModel& model);

}  // namespace meridian::simulate
