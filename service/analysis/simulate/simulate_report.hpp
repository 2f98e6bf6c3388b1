// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/path/block_reject.hpp"
#include "meridian/planner/relaxed_axis.hpp"
#include "meridian/planner/rewind.hpp"

namespace meridian::simulate {

/// How a simulated run ended.
enum class Outcome : std::uint8_t {
  kDone,     ///< the end of the program was reached
  kStopped,  ///< an operator event left it held, aborted or at an override of zero
  kRefused,  ///< a block was refused; the blocks before it have run
  kStarved,  ///< the blocks ended without an end block
  kFault     ///< the cycle raised an alarm
};

/// Which limit was nearest while the program ran: cycles in which the tip's feed, or velocity,
/// acceleration or jerk of a joint or drive took the largest share of what it may.
struct LimitShares {
  std::uint64_t feed = 0;
  std::array<std::array<std::uint64_t, 3>, kMaxLimited> joints{};
  std::uint64_t none = 0;  ///< nothing above half its limit
  std::uint64_t cycles = 0;
};

/// Something that happened, with the cycle in which it did.
struct Happening {
  std::uint64_t cycle = 0;
  Event event;
};

/// What came of a simulated run. Units: s, mm.
struct SimulateReport {
  std::string name;
  Outcome outcome = Outcome::kDone;
  std::string reason;  ///< kRefused, kFault: a sentence
  std::uint64_t cycles = 0;
  double cycle_s = 0;
  double approach_s = 0;  ///< from the start to the end of the approach
  double program_s = 0;   ///< from there to the end
  double waiting_s = 0;   ///< of it: at rest at dwells, actions, stops, holds
  /// Of it, in exact stop: what setting off from rests and coming to them costs the cuts.
  double vertex_stops_s = 0;
  double at_feed_s = 0;  ///< what the cuts alone would take at the programmed feed
  double cut_length_mm = 0, rapid_length_mm = 0;
  std::uint64_t blocks = 0, motion_blocks = 0, blocks_done = 0;
  std::uint64_t feeds_limited = 0;        ///< blocks above the machine's highest feed
  double computing_s = 0;                 ///< of this host
  std::vector<RelaxedAxis> relaxed_axes;  ///< beside the pole: the first ones
  std::uint64_t relaxed_count = 0;
  double largest_deviation_rad = 0;
  std::vector<Rewind> rewinds;  ///< of the redundant joint: the first ones
  std::uint64_t rewind_count = 0;
  LimitShares shares;
  std::vector<Happening> happenings;  ///< the first kMaxHappenings: state changes, alarms
  std::uint64_t happenings_dropped = 0;
  static constexpr std::size_t kMaxHappenings = 200;
};

/// The report for a person.
[[nodiscard]] std::string to_text(const SimulateReport& report, const MachineModel& model);

}  // namespace meridian::simulate
