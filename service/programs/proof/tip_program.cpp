// SPDX-License-Identifier: Apache-2.0
#include "service/programs/proof/tip_program.hpp"

#include "service/programs/cl/cl_points.hpp"

namespace meridian::proof {

std::vector<ProgramStep> steps_of_tip(const std::vector<ClBlock>& program) {
  constexpr double kChord_mm = 1e-5;
  using Kind = ProgramStep::Kind;
  cl::PointWalker walker(kChord_mm);
  std::vector<ProgramStep> steps;
  for (const ClBlock& block : program) {
    if (block.kind == BlockKind::kTool) {
      steps.push_back({Kind::kTool, block.line, static_cast<int>(block.value), {}, true});
    } else if (block.kind == BlockKind::kEnd) {
      steps.push_back({Kind::kEnd, block.line, 0, {}, true});
    }
    const Kind kind = block.kind == BlockKind::kRapid ? Kind::kRapid : Kind::kCut;
    walker.walk(block, [&](const cl::ClPoint& point) {
      steps.push_back({kind, block.line, 0, {}, true, ToolPose{point.tip, point.axis}});
    });
  }
  return steps;
}

}  // namespace meridian::proof
