// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <vector>

#include "meridian/kinematics/tool_table.hpp"
#include "service/programs/cl/cl_options.hpp"
#include "service/recording/record/check/check.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::test {

/// A stretch of a recording in which a part was cut from some line on.
struct PartCut {
  std::filesystem::path recording;
  std::uint32_t from_line = 0;  ///< as of `meridian stream --from-line`; 0: from the begin
  std::uint64_t from_cycle = 0;
  std::uint64_t to_cycle = std::numeric_limits<std::uint64_t>::max();
  bool is_finished = true;  ///< up to the part's end
  /// Its FaultStop began where drives were that had lost the path: there joints alone are checked.
  bool has_left_path = false;
  double tool_mm = 0;             ///< in the spindle at its begin; 0: the machine's
  std::uint64_t max_missing = 0;  ///< cycles that the recording may lack
};

/// Cycles that the recording of a service lacks by its own account, since it began.
[[nodiscard]] inline std::uint64_t cycles_lost(const dds::Status& status) {
  return status.periods_lost + status.records_overrun;
}

/// `cut` ends where the machine is `now`, and lacks no more cycles than the service lost since it
/// had lost `lost_before`.
inline void end_at(PartCut& cut, const dds::Status& now, std::uint64_t lost_before = 0) {
  cut.to_cycle = now.cycle;
  cut.max_missing = cycles_lost(now) - lost_before;
}

/// The part that was to be cut, and on which machine.
struct PartAsked {
  const MachineModel& model;
  const ToolTable& tools;
  std::filesystem::path file;
  std::vector<std::uint32_t> motions;  ///< lines that move the tool
};

/// Whether the recording passes with this tool in the spindle at the begin of the cut.
[[nodiscard]] bool passes_with(const PartAsked& part, const PartCut& cut, double tool_mm);

/// Lines of a CL file that move the tool.
[[nodiscard]] std::vector<std::uint32_t> motion_lines(const MachineModel& model,
                                                      const ToolTable& tools,
                                                      const std::filesystem::path& file);

/// What one stretch has moved along.
struct LinesCut {
  std::uint32_t first = 0, last = 0;  ///< 0: none
  bool is_last_done = false;          ///< the tool came to the end of it
};

/// Checks a stretch as `meridian check` does, and that it never goes back. Failures are those of
/// GoogleTest; they say what the recording holds.
[[nodiscard]] LinesCut check(const PartAsked& part, const PartCut& cut);

/// Two stretches, of which the second began at `from_line`, together cut every line: none is lost
/// between them, and none but that line is in both. `is_late`: of a journal that is a while old
/// more may be.
void expect_seam(const PartAsked& part, const LinesCut& before, const LinesCut& after,
                 std::uint32_t from_line, bool is_late = false);

}  // namespace meridian::test
