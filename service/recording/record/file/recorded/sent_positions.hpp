// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "meridian/kinematics/limited.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::record {

/// Where drive `i` was sent in that row, drive coordinates.
[[nodiscard]] inline double sent_position(const RecordingRow& row, const MachineModel& model,
                                          int i) noexcept {
  const auto first = static_cast<std::size_t>(model.joint_count);
  if (has_stage(model) && i == model.stage.linear_joint) return row.positions[first];
  if (has_stage(model) && i == model.stage.rotary_joint) return row.positions[first + 1];
  return row.joints[static_cast<std::size_t>(i)];
}

/// The setpoints of the last cycles, which feedback refers to by their number.
class SentPositions {
 public:
  void note(const RecordingRow& row, const MachineModel& model) noexcept {
    auto& [cycle, positions] = sent_[row.cycle % kRemembered];
    cycle = row.cycle;
    for (int i = 0; i < model.joint_count; ++i) {
      positions[static_cast<std::size_t>(i)] = sent_position(row, model, i);
    }
  }
  /// What the row's feedback had seen; nullptr where that is too old or was never sent.
  [[nodiscard]] const JointVector* seen_by(const RecordingRow& row) const noexcept {
    const auto& [cycle, positions] = sent_[row.feedback_cycle % kRemembered];
    return row.feedback_cycle != 0 && cycle == row.feedback_cycle ? &positions : nullptr;
  }

 private:
  static constexpr std::size_t kRemembered = 1024;
  std::array<std::pair<std::uint64_t, JointVector>, kRemembered> sent_{};
};

}  // namespace meridian::record
