// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

/// Blocks, and a planner from rest to rest that they are given to one by one.
namespace meridian::test::rest_to_rest {

inline ClBlock block_of(BlockKind kind, std::uint64_t sequence) {
  ClBlock block;
  block.kind = kind;
  block.sequence = sequence;
  block.line = static_cast<std::uint32_t>(sequence) + 100;
  return block;
}

inline ClBlock cut(std::uint64_t sequence, const Vector3& tip, const Vector3& axis,
                   double feed = 50) {
  ClBlock block = block_of(BlockKind::kCut, sequence);
  block.tip_mm = to_array(tip);
  block.axis = to_array(axis);
  block.feed_meaning = FeedMeaning::kTip;
  block.feed = feed;
  return block;
}

/// A planner at its port, and all that it published.
struct Bench {
  explicit Bench(const MachineModel& m = lai_machine(), const ToolTable& tools = {})
      : model(m), planner(model, tools) {
    planner.begin(start, model.tool_length_mm, 0);
  }
  PlanResult plan(const ClBlock& block) { return planner.plan(block, writer); }
  PlanResult plan_and_take(const ClBlock& block) {
    const PlanResult result = plan(block);
    take();
    return result;
  }
  void take() {
    while (const TimePiece* piece = reader.advance()) {
      times.push_back(*piece);
      paths.push_back(reader.path() != nullptr ? *reader.path() : PathPiece{});
    }
  }
  void forget() {
    take();
    times.clear();
    paths.clear();
  }
  [[nodiscard]] double duration() const {
    double sum = 0;
    for (const TimePiece& piece : times) sum += piece.duration;
    return sum;
  }

  MachineModel model;
  JointVector start{10, 20, -30, 0.5, 0.1, 0};
  std::unique_ptr<MotionPort> port = std::make_unique<MotionPort>();
  MotionWriter writer{*port};
  MotionReader reader{*port};
  RestToRestPlanner planner;
  std::vector<TimePiece> times;
  std::vector<PathPiece> paths;
};

}  // namespace meridian::test::rest_to_rest
