// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/recording/record/check/check_report.hpp"
#include "service/recording/record/check/motion/feed_overrides.hpp"
#include "service/recording/record/check/path/checked_path.hpp"
#include "service/recording/record/file/recorded/recorded_limits.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::record {

struct CheckOptions {
  double tip_tolerance_mm = 0;    ///< 0: the machine's
  double axis_tolerance_rad = 0;  ///< 0: the machine's
  double pole_tolerance_rad = 0;  ///< of the axis beside the pole; set by check()
  std::uint64_t max_missing = 0;  ///< cycles that may be missing
  double feed_factor = 1;         ///< highest feed override in the run, where `overrides` is empty
  std::vector<FeedOverride> overrides;  ///< those of the run: each holds when and as long as it did
  bool allow_unfinished = false;        ///< the run was ended before the path was
  std::vector<LimitsFrom> soft_limits;  ///< those of the run, each until the next
  std::uint64_t from_cycle = 0;         ///< rows before are not looked at
  std::uint64_t to_cycle = std::numeric_limits<std::uint64_t>::max();

  /// Highest feed override of the run, at least 1.
  [[nodiscard]] double max_feed_factor() const noexcept;
};

/// Checks a recording against the path of its CL file and the limits of the machine, by forward
/// kinematics and finite differences alone:
///
/// * there is a monotone matching of commanded poses and path, from begin to end, in which every
///   pose, at the setpoints and at three points between neighbouring ones (cubic through four), and
///   every CL vertex in its turn is within tip and axis tolerance together: nothing is missing,
///   nothing more is cut, nothing in another order;
/// * rows of kind `unwind` leave the path along the tool axis alone, turn the redundant joint by
///   whole turns, or the axis through the pole, off the part, and come back to where they left;
/// * tip speed never above the programmed feed, times the feed override in force or in force as
///   long before as the machine takes to follow; inverse time: tip and axis never faster than the
///   fastest block within 5 mm asks for, and no block in less than its time;
/// * the machine does not creep while it runs (creep_check.hpp);
/// * the tip in its box, in the cut and the approach to it, or going no farther out;
/// * velocity, acceleration, jerk of every joint, inside runs of consecutive cycles, to 1e-6
///   relative and 8 ulp(q)/T^n; FaultStop rows by the FaultStop limits; travel, and
///   soft limits, outside of which a joint may only come back; keep-out boxes in the same manner;
/// * not a dry run and a run that drives followed in one recording, of which the first alone would
///   be held against the path;
/// * missing cycles, their order, due times on the grid; sent velocities fit the positions.
///
/// Reads the recording twice, in memory that grows with the path alone. Source: docs/recordings.md.
/// Proof: tests/unit/record/check_test.cpp, check_ends_test.cpp, check_inverse_time_test.cpp (every
/// kind of finding provoked).
[[nodiscard]] Expected<CheckReport, RecordError> check(RecordingReader& recording,
                                                       const CheckedPath& path,
                                                       const MachineModel& model,
                                                       const CheckOptions& options);

}  // namespace meridian::record
