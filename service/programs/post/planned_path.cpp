// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/planned_path.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/travel_rounding.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/units.hpp"

namespace meridian::post {
namespace {

[[nodiscard]] std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// "C at 400 deg leaves its travel of -360 to 360 deg".
[[nodiscard]] std::string travel_text(const BlockReject& reject, const MachineModel& model) {
  if (reject.joint < 0 || reject.joint >= limited_count(model)) return "a joint leaves its travel";
  const JointSpec& joint = limited_spec(model, reject.joint);
  const auto shown = [&joint](double value) {
    return number(joint.is_rotary ? units::deg_from_rad(value) : value);
  };
  return joint.name + " at " + shown(reject.value) + " leaves its travel of " +
         shown(joint.limits.travel_min) + " to " + shown(joint.limits.travel_max) +
         (joint.is_rotary ? " deg" : " mm");
}

/// What lets the redundant joint be turned back; empty where that is not what is missing.
[[nodiscard]] std::string rewind_remedy(const BlockReject& reject, const MachineModel& model) {
  const bool is_refused = model.rewind_policy == RewindPolicy::kRefuse;
  const bool is_rotary = reject.joint >= 0 && reject.joint < limited_count(model) &&
                         limited_spec(model, reject.joint).is_rotary;
  if (!is_refused || !is_rotary || redundant_joint(model) < 0) return {};
  return reject.joint == redundant_joint(model)
             ? "; [rewind] policy = \"retract\" in the machine file turns it back off the part"
             : "; [rewind] policy = \"retract\" in the machine file may go to the other branch "
               "off the part";
}

[[nodiscard]] std::string reason(const BlockReject& reject, const MachineModel& model) {
  switch (reject.code) {
    case RejectCode::kUnreachable:
      return "no joint positions of machine " + model.name + " put the tool there";
    case RejectCode::kTravel:
      return travel_text(reject, model) + " at this pose on every branch and winding";
    case RejectCode::kTravelBetween:
      return travel_text(reject, model) + " on the way from the block before" +
             rewind_remedy(reject, model);
    case RejectCode::kKeepOut:
      return std::string("joints enter the keep-out box ") + model.keep_out.name_of(reject.value);
    case RejectCode::kTipBox:
      return "the tip leaves the tip box";
    case RejectCode::kBranch:
      return "no branch or winding leads here from the block before";
    case RejectCode::kApproach:
      return "no way leads here from the machine's home position";
    case RejectCode::kAxisReversal:
      return "the tool axis turns by half a turn at once: no way round is meant; add a point "
             "between";
    case RejectCode::kUnknownTool:
      return "tool " + number(reject.value) + " is not in the tool table; name one with --tools";
    case RejectCode::kFeed:
      return "the feed is not positive";
    case RejectCode::kTooComplex:
      return "the block is too long or too curved for one plan; split it";
    default:
      return "the planner refuses it (code " + std::to_string(static_cast<int>(reject.code)) + ")";
  }
}

}  // namespace

PlannedPath::PlannedPath(const MachineModel& model, ToolTable tools, BlockMotion motion)
    : model_(model),
      motion_(motion),
      port_(std::make_unique<MotionPort>()),
      writer_(*port_),
      planner_(model, std::move(tools)) {
  JointVector home{};
  for (int i = 0; i < model.joint_count; ++i) home[i] = model.joints[i].home;
  planner_.begin(home, model.tool_length_mm, epoch_);
}

/// A line that ends beyond travel by rounding alone ends at the end of travel, as in the service.
ClBlock PlannedPath::inside_travel(ClBlock block) const {
  if (!is_motion(block.kind) || block.is_arc) return block;
  const ToolPose pose{to_vector(block.tip_mm), to_vector(block.axis)};
  if (const auto taken = taken_into_travel(model_, tool_length_mm(), pose, joints())) {
    block.tip_mm = to_array(taken->tip);
    block.axis = to_array(taken->axis);
  }
  return block;
}

Expected<std::vector<PlannedPiece>, PostError> PlannedPath::plan(const ClBlock& programmed,
                                                                 std::span<const ClBlock> ahead) {
  const ClBlock block = inside_travel(programmed);
  planner_.look_at(ahead);
  const PlanResult result = planner_.plan(block, writer_);
  planner_.look_at({});
  if (result.status != PlanStatus::kOk) {
    const std::uint32_t line = result.reject.line > 0 ? result.reject.line : block.line;
    return tl::make_unexpected(PostError{line, reason(result.reject, model_)});
  }
  if (result.rewind.is_made() && motion_ != BlockMotion::kDrives) {
    return tl::make_unexpected(PostError{
        block.line,
        limited_spec(model_, result.rewind.joint).name +
            " runs out of its travel here and a rewind off the part is needed: under tool-centre "
            "control the tip would follow the turn; --dialect joints writes the "
            "rewind, or split the program ahead of this line"});
  }
  std::vector<PlannedPiece> pieces;
  for (PathPiece piece; port_->paths.try_pop(piece);) {
    // Where azimuth leads, tip and axis take the same way at another pace: the plain piece.
    piece.is_azimuthal = false;
    pieces.push_back({piece, 0});
  }
  std::size_t at = 0;
  for (TimePiece time; port_->times.try_pop(time);) {
    if (time.kind != TimeKind::kMove) continue;
    while (at < pieces.size() && pieces[at].piece.index != time.path_index) ++at;
    if (at < pieces.size()) pieces[at].feed_mm_per_s = time.feed_mm_per_s;
  }
  return pieces;
}

void PlannedPath::begin_again() {
  planner_.begin(JointVector(planner_.joints()), planner_.tool_length_mm(), ++epoch_);
}

double path_length(const PathPiece& piece) noexcept {
  if (piece.kind == PathKind::kTurn || piece.kind == PathKind::kJoint) return 0;
  return std::hypot(tip_length(piece), kAxisLength_mm_per_rad * piece.axis_turn);
}

}  // namespace meridian::post
