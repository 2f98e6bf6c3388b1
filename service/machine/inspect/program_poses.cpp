// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/program_poses.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "meridian/geometry/vector3.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"

namespace meridian::inspect {
namespace {

/// Between two poses an arc or the axis turns by no more than this.
constexpr double kTurn_rad = 0.15;

ToolPose end_of(const ClBlock& block) {
  return {to_vector(block.tip_mm), to_vector(block.axis).normalized()};
}

/// How many poses stand for the block.
int poses_for(const ClBlock& block, const ToolPose& from, const ToolPose& to) {
  const double turn = std::acos(std::clamp(from.axis.dot(to.axis), -1.0, 1.0));
  const double arc = block.is_arc ? block.sweep_rad : 0.0;
  return std::max(1, static_cast<int>(std::ceil(std::max(turn, arc) / kTurn_rad)));
}

/// What the feed of `block` allows for its path of `length_mm`.
double feed_time_of(const ClBlock& block, double length_mm) {
  if (block.feed_meaning == FeedMeaning::kNone || !(block.feed > 0)) return 0;
  return block.feed_meaning == FeedMeaning::kInverseTime ? 1 / block.feed : length_mm / block.feed;
}

}  // namespace

Expected<std::vector<ProgramPose>, cl::ClError> read_poses(cl::ClReader& reader,
                                                           const MachineModel& model,
                                                           const ToolTable& tools) {
  std::vector<ProgramPose> poses;
  double tool_length_mm = model.tool_length_mm;
  std::optional<ToolPose> from;
  for (;;) {
    const auto read = reader.next();
    if (!read) return tl::make_unexpected(read.error());
    if (!*read) return poses;
    const ClBlock& block = **read;
    if (block.kind == BlockKind::kTool) {
      const Tool* const tool = tools.find(static_cast<int>(block.value));
      if (tool != nullptr) tool_length_mm = tool->tip_length_mm();
    }
    if (!is_motion(block.kind)) continue;
    const ToolPose to = end_of(block);
    const bool has_path = from && from->axis.dot(to.axis) > -0.999;
    const int count = has_path ? poses_for(block, *from, to) : 1;
    const PathPiece piece = !has_path      ? PathPiece{}
                            : block.is_arc ? make_arc(*from, to, block)
                                           : make_line(*from, to);
    const double length_mm = has_path ? piece.length : from ? (to.tip - from->tip).norm() : 0;
    const double feed_time_s = feed_time_of(block, length_mm) / count;
    for (int n = 1; n < count; ++n) {
      const auto at = pose_at(piece, piece.length * n / count);
      poses.push_back({at, tool_length_mm, block.line, feed_time_s});
    }
    poses.push_back({to, tool_length_mm, block.line, feed_time_s});
    from = to;
  }
}

}  // namespace meridian::inspect
