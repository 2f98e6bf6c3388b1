// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/block_feed.hpp"

#include <algorithm>

#include "meridian/path/build_piece.hpp"

namespace meridian::simulate {
BlockFeed::BlockFeed(cl::ClReader& reader, const MachineModel& model, const ToolTable& tools,
                     MotionPort& port, bool has_action_peer, Explainer* explainer)
    : reader_(reader),
      model_(model),
      check_(model, stream::lengths_of(tools)),
      actions_{.is_there = has_action_peer, .is_ignored = false},
      planner_(model, tools),
      writer_(port),
      explainer_(explainer) {
  if (model.max_feed_override > 1) writer_.set_horizon(kFeedHorizon_s);
}

void BlockFeed::begin(const JointVector& at_rest, std::uint16_t epoch,
                      const SmoothSettings& settings) {
  check_.begin(model_.tool_length_mm);
  planner_.begin(at_rest, model_.tool_length_mm, epoch, settings);
  writer_.forget_ahead();  // what was published has run or is void
  has_begun_ = true;
}

/// Reads and checks the next block into `block_`; false if there is none to plan.
bool BlockFeed::take_block() {
  auto read = reader_.next();
  if (!read) {
    refusal_ = read.error().text();
    return false;
  }
  if (!*read) return false;
  const double programmed_feed = (*read)->feed;
  const BlockReject verdict = check_.check(**read, actions_);
  if (verdict.code != RejectCode::kNone) {
    refusal_ = stream::describe(verdict, model_);
    return false;
  }
  block_ = **read;
  if (is_motion(block_->kind)) ++motion_blocks_;
  if (explainer_ != nullptr) explain(*block_, programmed_feed);
  return true;
}

void BlockFeed::explain(const ClBlock& block, double programmed_feed) {
  double tip_mm = 0, path_mm = 0;
  if (is_motion(block.kind)) {
    const ToolPose end{to_vector(block.tip_mm), to_vector(block.axis)};
    if (pose_) {  // the first one is where the approach ends
      const PathPiece path = block.is_arc ? make_arc(*pose_, end, block) : make_line(*pose_, end);
      tip_mm = tip_length(path);
      path_mm = path.length;
    }
    pose_ = end;
  }
  explainer_->add_block(block, programmed_feed, tip_mm, path_mm);
}

void BlockFeed::take_relaxed_axes() {
  RelaxedAxis relaxed_axis;
  while (planner_.take_relaxed_axis(relaxed_axis)) {
    ++relaxed_axes_.count;
    relaxed_axes_.largest_rad = std::max(relaxed_axes_.largest_rad, relaxed_axis.deviation_rad);
    if (relaxed_axes_.first.size() < kMaxRelaxedAxes) relaxed_axes_.first.push_back(relaxed_axis);
    if (explainer_ != nullptr) {
      explainer_->add_relaxed_axis(relaxed_axis.first_sequence, relaxed_axis.last_sequence,
                                   relaxed_axis.deviation_rad);
    }
  }
  Rewind rewind;
  while (planner_.take_rewind(rewind)) {
    ++rewind_count_;
    if (rewinds_.size() < kMaxRelaxedAxes) rewinds_.push_back(rewind);
  }
}

/// Publishes what became ready without a block.
void BlockFeed::advance() {
  const PlanResult result = planner_.advance(writer_);
  take_relaxed_axes();
  if (result.status == PlanStatus::kRefused) end_at(result.reject);
}

void BlockFeed::end_at(const BlockReject& reject) {
  if (refusal_.empty()) refusal_ = stream::describe(reject, model_);
  is_over_ = true;
}

void BlockFeed::fill() {
  advance();
  while (!is_over_) {
    if (!block_ && !take_block()) {
      is_over_ = true;
      planner_.finish();
      advance();
      return;
    }
    const PlanResult result = planner_.plan(*block_, writer_);
    take_relaxed_axes();
    if (result.status == PlanStatus::kNoRoom) return;
    if (result.status == PlanStatus::kRefused) {
      end_at(result.reject);
      return;
    }
    block_.reset();
  }
}

}  // namespace meridian::simulate
