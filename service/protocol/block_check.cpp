// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/block_check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/kinematics/travel_rounding.hpp"
#include "meridian/units.hpp"

namespace meridian::stream {

namespace {

BlockReject reject(const ClBlock& block, RejectCode code, double value = 0, int joint = -1) {
  return {block.sequence, block.line, code, joint, value};
}

/// Returns the place of the first number of `block` that is not finite (the order of kPlaces in
/// describe.cpp); -1 where all are.
int first_not_finite(const ClBlock& block) {
  const double numbers[] = {
      block.tip_mm[0],    block.tip_mm[1], block.tip_mm[2], block.axis[0],      block.axis[1],
      block.axis[2],      block.feed,      block.value,     block.centre_mm[0], block.centre_mm[1],
      block.centre_mm[2], block.normal[0], block.normal[1], block.normal[2],    block.sweep_rad};
  const auto* bad = std::find_if_not(std::begin(numbers), std::end(numbers),
                                     [](double number) { return std::isfinite(number); });
  return bad == std::end(numbers) ? -1 : static_cast<int>(bad - std::begin(numbers));
}

/// Normalises a vector that is near unit length; false where it is not. A vector that is unit
/// within rounding stays as it is, so that checking twice gives the same bits.
bool make_unit(Array3& vector) {
  const double norm = to_vector(vector).norm();
  if (!(std::abs(norm - 1) <= kAxisNormTolerance)) return false;
  if (std::abs(norm - 1) > 4 * std::numeric_limits<double>::epsilon()) {
    vector = to_array(to_vector(vector) / norm);
  }
  return true;
}

/// Length of the tip's path from `begin`.
double tip_length(const ClBlock& block, const Array3& begin) {
  const Vector3 from = to_vector(begin), to = to_vector(block.tip_mm);
  if (!block.is_arc) return (to - from).norm();
  const Vector3 normal = to_vector(block.normal);
  const Vector3 radius = from - to_vector(block.centre_mm);
  return std::hypot((radius - radius.dot(normal) * normal).norm() * block.sweep_rad,
                    (to - from).dot(normal));
}

/// The keep-out box that `q` is inside of; -1: none, or another winding of one of its joints may
/// be outside.
[[nodiscard]] int keep_out_that_holds(const MachineModel& model, const JointVector& q) {
  const int number = keep_out_at(model.keep_out, q);
  if (number < 0) return number;
  const KeepOutBox& box = model.keep_out.boxes()[static_cast<std::size_t>(number)];
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& joint = model.joints[i];
    const double travel = joint.limits.travel_max - joint.limits.travel_min;
    if (box.has(i) && joint.is_rotary && travel >= kTurn_rad) return -1;
  }
  return number;
}

[[nodiscard]] bool holds_control_character(const char* text) noexcept {
  for (; *text != '\0'; ++text) {
    if (static_cast<unsigned char>(*text) < 0x20 || *text == 0x7F) return true;
  }
  return false;
}

}  // namespace

ToolLengths lengths_of(const ToolTable& tools) {
  ToolLengths lengths;
  for (const Tool& tool : tools.tools()) {
    lengths.emplace(static_cast<std::uint32_t>(tool.number), tool.tip_length_mm());
  }
  return lengths;
}

BlockCheck::BlockCheck(const MachineModel& model, ToolLengths tools)
    : model_(model), tools_(std::move(tools)), tool_length_mm_(model.tool_length_mm) {
  begin(model.tool_length_mm);
}

void BlockCheck::begin(double tool_length_mm) {
  tool_length_mm_ = tool_length_mm;
  for (int i = 0; i < model_.joint_count; ++i) joints_[i] = model_.joints[i].home;
  has_tip_ = false;
  feeds_limited_ = 0;
  first_limited_line_ = 0;
  poses_rounded_ = 0;
  first_rounded_line_ = 0;
}

BlockReject BlockCheck::check(ClBlock& block, const ActionPeer& actions) {
  if (block.kind > BlockKind::kEnd || block.feed_meaning > FeedMeaning::kInverseTime ||
      block.action > ActionKind::kVendorWord) {
    return reject(block, RejectCode::kKind);
  }
  if (const int index = first_not_finite(block); index >= 0) {
    return reject(block, RejectCode::kNotFinite, index);
  }
  block.text[sizeof block.text - 1] = '\0';
  // It goes on to terminals and to other machines' controls.
  if (holds_control_character(block.text)) return reject(block, RejectCode::kKind);
  switch (block.kind) {
    case BlockKind::kCut:
    case BlockKind::kRapid:
      return check_motion(block);
    case BlockKind::kDwell:
      if (!(block.value >= 0 && block.value <= kMaxDwell_s)) {
        return reject(block, RejectCode::kValue, block.value);
      }
      break;
    case BlockKind::kAuxiliary:
    case BlockKind::kTool:
    case BlockKind::kStop:
      if (!actions.is_there && !actions.is_ignored) {
        return reject(block, RejectCode::kNoActionPeer);
      }
      if (block.value < 0) return reject(block, RejectCode::kValue, block.value);
      if (block.kind == BlockKind::kTool) return check_tool(block);
      break;
    case BlockKind::kOptionalStop:
    case BlockKind::kEnd:
      break;
  }
  return reject(block, RejectCode::kNone);
}

BlockReject BlockCheck::check_motion(ClBlock& block) {
  const double axis_norm = to_vector(block.axis).norm();
  if (!make_unit(block.axis)) return reject(block, RejectCode::kAxisNotUnit, axis_norm);
  if (block.is_arc) {
    if (const BlockReject verdict = check_arc(block); verdict.code != RejectCode::kNone) {
      return verdict;
    }
  }
  if (const BlockReject verdict = check_feed(block); verdict.code != RejectCode::kNone) {
    return verdict;
  }
  const BlockReject verdict = check_pose(block);
  if (verdict.code == RejectCode::kNone) {
    tip_ = block.tip_mm;
    has_tip_ = true;
  }
  return verdict;
}

BlockReject BlockCheck::check_arc(ClBlock& block) const {
  const double normal_norm = to_vector(block.normal).norm();
  if (!make_unit(block.normal)) return reject(block, RejectCode::kAxisNotUnit, normal_norm);
  if (!has_tip_) return reject(block, RejectCode::kArc, std::numeric_limits<double>::infinity());
  constexpr double kWholeTurn_rad = 2 * std::numbers::pi * (1 + 1e-12);
  if (!(block.sweep_rad > 0 && block.sweep_rad <= kWholeTurn_rad)) {
    return reject(block, RejectCode::kArc, block.sweep_rad);
  }
  const Vector3 normal = to_vector(block.normal);
  const Vector3 begin = to_vector(tip_) - to_vector(block.centre_mm);
  const Vector3 radius = begin - begin.dot(normal) * normal;
  const Vector3 end = to_vector(block.tip_mm) - to_vector(block.centre_mm);
  const Vector3 reached = std::cos(block.sweep_rad) * radius +
                          std::sin(block.sweep_rad) * normal.cross(radius) +
                          end.dot(normal) * normal;
  const double miss_mm = (reached - end).norm();
  if (!(miss_mm <= kArcTolerance_mm && radius.norm() > 0)) {
    return reject(block, RejectCode::kArc, miss_mm);
  }
  return reject(block, RejectCode::kNone);
}

BlockReject BlockCheck::check_feed(ClBlock& block) {
  if (block.kind == BlockKind::kRapid) return reject(block, RejectCode::kNone);
  const double per_min = units::per_min_from_per_s(block.feed);
  const double length_mm = has_tip_ ? tip_length(block, tip_) : 0;
  const bool is_inverse = block.feed_meaning == FeedMeaning::kInverseTime;
  const double tip_mm_per_s = is_inverse ? block.feed * length_mm : block.feed;
  if (block.feed_meaning == FeedMeaning::kNone || !(block.feed > 0) ||
      per_min > kMaxFeed_mm_per_min ||
      units::per_min_from_per_s(tip_mm_per_s) > kMaxFeed_mm_per_min) {
    return reject(block, RejectCode::kFeed, per_min);
  }
  if (model_.max_feed_mm_per_s > 0 && tip_mm_per_s > model_.max_feed_mm_per_s) {
    block.feed = is_inverse ? model_.max_feed_mm_per_s / length_mm : model_.max_feed_mm_per_s;
    if (feeds_limited_++ == 0) first_limited_line_ = block.line;
  }
  return reject(block, RejectCode::kNone);
}

/// A line that ends beyond travel by rounding alone is taken to the end of travel. Where only one
/// of several branches is, it is taken there too: the path may come along that branch.
BlockReject BlockCheck::check_pose(ClBlock& block) {
  bool is_marginal = false;
  const BlockReject verdict = find_joints(block, is_marginal);
  if (!is_marginal || block.is_arc) return verdict;
  const ToolPose pose{to_vector(block.tip_mm), to_vector(block.axis)};
  const auto taken = taken_into_travel(model_, tool_length_mm_, pose, joints_);
  if (!taken) return verdict;
  block.tip_mm = to_array(taken->tip);
  block.axis = to_array(taken->axis);
  if (poses_rounded_++ == 0) first_rounded_line_ = block.line;
  return find_joints(block, is_marginal);
}

/// `is_marginal`: on some branch a joint is outside travel, and none by more than rounding makes.
BlockReject BlockCheck::find_joints(const ClBlock& block, bool& is_marginal) {
  const ToolPose pose{to_vector(block.tip_mm), to_vector(block.axis)};
  BlockReject first = reject(block, RejectCode::kUnreachable);
  bool has_joints = false;
  const auto passes = [&](Solution<double> found) {
    if (found.status == SolveStatus::kUnreachable) return false;
    wind_into_travel(model_, joints_, found.q);
    const int outside = first_joint_outside_travel(model_, found.q, kTravelTolerance);
    const int box = outside < 0 ? keep_out_that_holds(model_, found.q) : -1;
    const int axis = outside < 0 ? tip_axis_outside(model_, tool_length_mm_, found.q) : -1;
    if (outside < 0 && box < 0 && axis < 0) {
      joints_ = found.q;
      return true;
    }
    is_marginal = is_marginal || taken_into_travel(model_, tool_length_mm_, found.q).has_value();
    if (!has_joints && box >= 0) first = reject(block, RejectCode::kKeepOut, box);
    if (!has_joints && box < 0 && axis >= 0) {
      const Array3 tip = tip_over_base(model_, tool_length_mm_, found.q);
      first = reject(block, RejectCode::kTipBox, tip[static_cast<std::size_t>(axis)], axis);
    }
    if (!has_joints && outside >= 0) {
      first = reject(block, RejectCode::kTravel, limited_value(model_, found.q, outside), outside);
    }
    has_joints = true;
    return false;
  };
  bool is_at_pole = false;
  for (int branch = 0; branch < branch_count(model_); ++branch) {
    const auto found = solve(model_, tool_length_mm_, pose, branch, joints_);
    is_at_pole = is_at_pole || found.status == SolveStatus::kAtPole;
    if (passes(found)) return reject(block, RejectCode::kNone);
  }
  if (is_at_pole) {
    // The redundant joint may stand anywhere here: look around the circle for a point inside
    // travel.
    constexpr int kSamples = 72;
    for (int i = 0; i < kSamples; ++i) {
      const double free = joints_[redundant_joint(model_)] + 2 * std::numbers::pi * i / kSamples;
      if (passes(solve_held(model_, tool_length_mm_, pose, free))) {
        return reject(block, RejectCode::kNone);
      }
    }
  }
  return first;
}

BlockReject BlockCheck::check_tool(const ClBlock& block) {
  const bool is_number = block.value == std::floor(block.value) &&
                         block.value <= std::numeric_limits<std::uint32_t>::max();
  const auto tool = is_number ? tools_.find(static_cast<std::uint32_t>(block.value)) : tools_.end();
  if (tool == tools_.end()) return reject(block, RejectCode::kUnknownTool, block.value);
  tool_length_mm_ = tool->second;
  return reject(block, RejectCode::kNone);
}

}  // namespace meridian::stream
