// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "meridian/path/block_reject.hpp"
#include "meridian/path/cl_block.hpp"

namespace meridian::stream {

/// Gauge line to tip, mm, of every tool that the machine has.
using ToolLengths = std::map<std::uint32_t, double>;

[[nodiscard]] ToolLengths lengths_of(const ToolTable& tools);

/// What the machine can do about action words at this moment.
struct ActionPeer {
  bool is_there = false;    ///< somebody reads actions and answers
  bool is_ignored = false;  ///< auxiliary = "ignore" in the service file
};

inline constexpr double kAxisNormTolerance = 1e-3;
inline constexpr double kMaxFeed_mm_per_min = 1e6;  ///< beyond it a feed is absurd
inline constexpr double kArcTolerance_mm = 0.05;    ///< begin and end of an arc on its circle
inline constexpr double kMaxDwell_s = 24 * 3600.0;
inline constexpr double kTravelTolerance = 1e-9;  ///< mm or rad

/// Checks block by block what a program asks for, before anything of it may move: finite numbers,
/// unit axis, sane feed, arc on its circle, known tool, pose reachable and inside travel in at
/// least one branch and winding. The way between blocks is the planner's to check. Station,
/// service and simulator use the same check, so that all three plan from the same bits.
/// Proof: tests/unit/protocol/block_check_test.cpp.
class BlockCheck {
 public:
  BlockCheck(const MachineModel& model, ToolLengths tools);

  /// Between two programs: the tools that the machine has from here on.
  void set_tools(ToolLengths tools) noexcept { tools_ = std::move(tools); }

  /// Forgets the program before; the next one starts with this tool in the spindle.
  void begin(double tool_length_mm);

  /// Returns the verdict on the next block, code kNone if it may pass. A block that passes has its
  /// tool axis and arc normal normalised (twice makes no difference), a feed above the machine's
  /// maximum limited to it, and the pose of a line that is beyond travel by rounding alone
  /// (travel_rounding.hpp) taken to the end of travel.
  [[nodiscard]] BlockReject check(ClBlock& block, const ActionPeer& actions);

  [[nodiscard]] std::uint64_t feeds_limited() const noexcept { return feeds_limited_; }
  [[nodiscard]] std::uint32_t first_limited_line() const noexcept { return first_limited_line_; }
  /// Poses taken to the end of travel, and the line of the first.
  [[nodiscard]] std::uint64_t poses_rounded() const noexcept { return poses_rounded_; }
  [[nodiscard]] std::uint32_t first_rounded_line() const noexcept { return first_rounded_line_; }
  [[nodiscard]] double tool_length_mm() const noexcept { return tool_length_mm_; }

 private:
  [[nodiscard]] BlockReject check_motion(ClBlock& block);
  [[nodiscard]] BlockReject check_arc(ClBlock& block) const;
  [[nodiscard]] BlockReject check_feed(ClBlock& block);
  [[nodiscard]] BlockReject check_pose(ClBlock& block);
  [[nodiscard]] BlockReject find_joints(const ClBlock& block, bool& is_marginal);
  [[nodiscard]] BlockReject check_tool(const ClBlock& block);

  const MachineModel& model_;
  ToolLengths tools_;
  double tool_length_mm_;
  JointVector joints_{};  ///< of the last pose that passed: where to look for the next
  Array3 tip_{};          ///< of the last motion block
  bool has_tip_ = false;
  std::uint64_t feeds_limited_ = 0;
  std::uint32_t first_limited_line_ = 0;
  std::uint64_t poses_rounded_ = 0;
  std::uint32_t first_rounded_line_ = 0;
};

/// The reason of a verdict for a person, and what is allowed; without line and block.
[[nodiscard]] std::string reason_of(const BlockReject& reject, const MachineModel& model);

/// Says a verdict in one sentence for a person: line, block, reason, what is allowed.
[[nodiscard]] std::string describe(const BlockReject& reject, const MachineModel& model);

}  // namespace meridian::stream
