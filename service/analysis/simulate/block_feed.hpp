// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "meridian/kinematics/tool_table.hpp"
#include "meridian/planner/smooth_planner.hpp"
#include "service/analysis/simulate/explainer.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/protocol/block_check.hpp"

namespace meridian::simulate {

/// Reader, check and planner in one hand: what station, intake and planner thread do live, block by
/// block in the same order, so that the plan is the same.
class BlockFeed {
 public:
  /// `explainer`: gets every block; may be nullptr.
  BlockFeed(cl::ClReader& reader, const MachineModel& model, const ToolTable& tools,
            MotionPort& port, bool has_action_peer, Explainer* explainer);

  /// Plans with the factors of a run before. `marks` must stay.
  void replay_feed(std::span<const FeedMark> marks) noexcept { planner_.replay_feed(marks); }

  /// Starts the program from joints at rest.
  void begin(const JointVector& at_rest, std::uint16_t epoch, const SmoothSettings& settings);
  /// Plans until the port is full, the blocks are through, or one is refused.
  void fill();

  [[nodiscard]] bool has_begun() const noexcept { return has_begun_; }
  /// No block will come any more.
  [[nodiscard]] bool is_over() const noexcept { return is_over_; }
  /// Why the last block was refused, one sentence; empty where none was.
  [[nodiscard]] const std::string& refusal() const noexcept { return refusal_; }
  /// Stretches beside the pole on which the axis was moved: the first kMaxRelaxedAxes, how many
  /// there were, the farthest.
  struct RelaxedAxes {
    std::vector<RelaxedAxis> first;
    std::uint64_t count = 0;
    double largest_rad = 0;
  };
  static constexpr std::size_t kMaxRelaxedAxes = 100;
  [[nodiscard]] const RelaxedAxes& relaxed_axes() const noexcept { return relaxed_axes_; }
  /// Rewinds so far, in order: the first kMaxRelaxedAxes.
  [[nodiscard]] const std::vector<Rewind>& rewinds() const noexcept { return rewinds_; }
  [[nodiscard]] std::uint64_t rewind_count() const noexcept { return rewind_count_; }
  [[nodiscard]] std::uint64_t motion_blocks() const noexcept { return motion_blocks_; }
  [[nodiscard]] std::uint64_t feeds_limited() const noexcept { return check_.feeds_limited(); }

 private:
  [[nodiscard]] bool take_block();
  void advance();
  /// `reject` is the end of the program.
  void end_at(const BlockReject& reject);
  void explain(const ClBlock& block, double programmed_feed);

  cl::ClReader& reader_;
  const MachineModel& model_;
  stream::BlockCheck check_;
  stream::ActionPeer actions_;
  SmoothPlanner planner_;
  MotionWriter writer_;
  Explainer* explainer_;
  std::optional<ToolPose> pose_;  ///< end of the last motion block
  std::optional<ClBlock> block_;  ///< checked, not planned yet
  void take_relaxed_axes();

  std::string refusal_;
  RelaxedAxes relaxed_axes_;
  std::vector<Rewind> rewinds_;
  std::uint64_t rewind_count_ = 0;
  std::uint64_t motion_blocks_ = 0;
  bool has_begun_ = false, is_over_ = false;
};

}  // namespace meridian::simulate
