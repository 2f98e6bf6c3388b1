// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/shape/side_milling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "service/programs/surface/sample_blocks.hpp"
#include "service/text/printed.hpp"

namespace meridian::surface {

using text::printed;
namespace {

constexpr double kWallLength_mm = 80, kWallHeight_mm = 20;
constexpr double kWave_mm = 6, kLean_mm = 3;
constexpr double kCutterRadius_mm = 5, kBelow_mm = 1;
constexpr double kBeyond = 0.1;  ///< of the wall's length, before it and behind it
constexpr int kBlocks = 96;
constexpr int kPiecesOfBlock = 8;  ///< of the swept flank
constexpr double kAbove_mm = 40, kNearWall_mm = 5;
constexpr double kSideFeed_mm_per_min = 1500, kSideSpindle_rpm = 9000;

/// Towards the cutter, at `height` from bottom (0) to top (1).
Vector3 normal_at(const Ruling& r, double height) {
  const Vector3 along = (1 - height) * r.bottom_rate + height * r.top_rate;
  return along.cross(r.top - r.bottom).normalized();
}

double part_of(int block) { return -kBeyond + (1 + 2 * kBeyond) * block / kBlocks; }

/// The tool at the ends of the sample's blocks.
std::vector<ToolPose> block_ends() {
  std::vector<ToolPose> out;
  for (int i = 0; i <= kBlocks; ++i) {
    out.push_back(flank_pose(sample_wall, part_of(i), kCutterRadius_mm, kBelow_mm));
  }
  return out;
}

/// The way between as well: the tip straight, the axis nearly on its great circle.
std::vector<ToolPose> swept(const std::vector<ToolPose>& ends) {
  std::vector<ToolPose> out = {ends.front()};
  for (std::size_t i = 1; i < ends.size(); ++i) {
    for (int k = 1; k <= kPiecesOfBlock; ++k) {
      const double share = static_cast<double>(k) / kPiecesOfBlock;
      out.push_back({ends[i - 1].tip + share * (ends[i].tip - ends[i - 1].tip),
                     (ends[i - 1].axis + share * (ends[i].axis - ends[i - 1].axis)).normalized()});
    }
  }
  return out;
}

}  // namespace

ToolPose flank_pose(const RuledWall& wall, double part, double radius_mm, double below_mm) {
  const Ruling r = wall(part);
  const Vector3 axis = (r.top - r.bottom).normalized();
  return {r.bottom + radius_mm * normal_at(r, 0.5) - below_mm * axis, axis};
}

FlankFit measure_flank(const RuledWall& wall, const std::vector<ToolPose>& poses,
                       double radius_mm) {
  constexpr int kAlong = 320, kUp = 20;
  FlankFit fit;
  for (int i = 0; i <= kAlong; ++i) {
    const Ruling r = wall(static_cast<double>(i) / kAlong);
    const Vector3 low = normal_at(r, 0), high = normal_at(r, 1);
    fit.twist_rad = std::max(fit.twist_rad, std::atan2(low.cross(high).norm(), low.dot(high)));
    for (int j = 0; j <= kUp; ++j) {
      const Vector3 point = r.bottom + static_cast<double>(j) / kUp * (r.top - r.bottom);
      double min = std::numeric_limits<double>::infinity();
      for (const ToolPose& pose : poses) {
        min = std::min(min, (point - pose.tip).cross(pose.axis).norm());
      }
      fit.undercut_mm = std::max(fit.undercut_mm, min - radius_mm);
      fit.overcut_mm = std::max(fit.overcut_mm, radius_mm - min);
    }
  }
  return fit;
}

Ruling sample_wall(double part) {
  constexpr double kTurn = 2 * std::numbers::pi, kLate = 0.9;
  const double x = kWallLength_mm * part, phase = kTurn * part;
  Ruling r;
  r.bottom = {x, kWave_mm * std::sin(phase), 0};
  r.bottom_rate = {kWallLength_mm, kTurn * kWave_mm * std::cos(phase), 0};
  r.top = r.bottom + Vector3(0, kLean_mm * std::sin(phase + kLate), kWallHeight_mm);
  r.top_rate = r.bottom_rate + Vector3(0, kTurn * kLean_mm * std::cos(phase + kLate), 0);
  return r;
}

std::vector<ClBlock> side_milling() {
  const std::vector<ToolPose> ends = block_ends();
  std::vector<ClBlock> blocks;
  blocks.push_back(action(BlockKind::kTool, ActionKind::kToolChange, 1));
  blocks.push_back(action(BlockKind::kAuxiliary, ActionKind::kSpindleClockwise, kSideSpindle_rpm));
  blocks.push_back(motion(BlockKind::kRapid, above(ends.front(), kAbove_mm), 0));
  blocks.push_back(action(BlockKind::kAuxiliary, ActionKind::kCoolantFlood, 0));
  blocks.push_back(motion(BlockKind::kRapid, above(ends.front(), kNearWall_mm), 0));
  for (const ToolPose& pose : ends) {
    blocks.push_back(motion(BlockKind::kCut, pose, kSideFeed_mm_per_min));
  }
  blocks.push_back(motion(BlockKind::kRapid, above(ends.back(), kAbove_mm), 0));
  blocks.push_back(action(BlockKind::kAuxiliary, ActionKind::kCoolantOff, 0));
  blocks.push_back(action(BlockKind::kAuxiliary, ActionKind::kSpindleOff, 0));
  blocks.push_back(action(BlockKind::kEnd, ActionKind::kNone, 0));
  return blocks;
}

std::string side_milling_report() {
  const FlankFit fit = measure_flank(sample_wall, swept(block_ends()), kCutterRadius_mm);
  std::string out = printed("wall      ruled, %.6g mm long, %.6g mm high; twist up to %.3f deg\n",
                            kWallLength_mm, kWallHeight_mm, units::deg_from_rad(fit.twist_rad));
  out += printed("cutter    flank of an end mill, diameter %.6g mm, along the rulings\n",
                 2 * kCutterRadius_mm);
  out += printed("undercut  at most %.6f mm\novercut   at most %.6f mm\n", fit.undercut_mm,
                 fit.overcut_mm);
  return out;
}

}  // namespace meridian::surface
