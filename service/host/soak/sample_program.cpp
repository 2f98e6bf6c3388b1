// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/sample_program.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "service/machine/inspect/inspection.hpp"
#include "service/programs/cl/cl_writer.hpp"

namespace meridian::soak {
namespace {

constexpr double kMaxDistance_mm = 12, kLargestTurn_deg = 6;

struct Swing {
  double amplitude = 0, pace = 0;  ///< mm or rad; rad per block
};

[[nodiscard]] double pick(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * std::ldexp(static_cast<double>(random() >> 11U), -53);
}

}  // namespace

void write_sample_program(const MachineModel& model, std::uint64_t seed,
                          const std::filesystem::path& file) {
  std::mt19937_64 random(seed);
  std::ofstream out(file);
  cl::ClWriter writer(out, "SOAK " + std::to_string(seed));
  const JointVector begin = inspect::trial_joints(model);
  const int blocks = 20 + static_cast<int>(pick(random, 0, 60));
  const double feed_mm_per_min = pick(random, 600, 4000);
  std::array<Swing, kMaxJoints> swings{};
  for (int joint = 0; joint < model.joint_count; ++joint) {
    const JointSpec& spec = model.joints[joint];
    const double max = spec.is_rotary ? units::rad_from_deg(kLargestTurn_deg) : kMaxDistance_mm;
    double amplitude = pick(random, 0.2, 1) * max;
    if (!is_inside_travel(spec, begin[joint] + amplitude, 0)) amplitude = -amplitude;
    swings[joint] = {amplitude, pick(random, 0.01, 0.06)};
  }
  for (int i = 0; i <= blocks; ++i) {
    JointVector q = begin;
    for (int joint = 0; joint < model.joint_count; ++joint) {
      // From the trial place to one side of it and back: 0 to 1 and never beyond.
      q[joint] += swings[joint].amplitude * 0.5 * (1 - std::cos(swings[joint].pace * i));
    }
    const ToolPose pose = forward(model, model.tool_length_mm, q);
    ClBlock block;
    block.kind = i == 0 ? BlockKind::kRapid : BlockKind::kCut;
    block.feed_meaning = i == 0 ? FeedMeaning::kNone : FeedMeaning::kTip;
    block.feed = i == 0 ? 0 : feed_mm_per_min / 60;
    block.tip_mm = to_array(pose.tip);
    block.axis = to_array(pose.axis);
    writer.write(block);
    if (i == blocks / 2) {
      ClBlock dwell;
      dwell.kind = BlockKind::kDwell;
      dwell.value = 0.2;
      writer.write(dwell);
    }
  }
  ClBlock end;
  end.kind = BlockKind::kEnd;
  writer.write(end);
}

}  // namespace meridian::soak
