// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/bridge/drive_positions.hpp"

namespace meridian::bridge {
namespace {
constexpr std::int64_t kTooOld_ns = 500'000'000;
}

void DrivePositions::add(const dds::DriveFeedback& feedback, std::int64_t now_ns) noexcept {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    if ((feedback.joint_mask >> i & 1U) == 0) continue;
    drives_[i] = {true, feedback.position[i], feedback.statusword[i], feedback.error[i], now_ns};
  }
}

void DrivePositions::pass(std::int64_t now_ns) noexcept {
  for (Drive& drive : drives_) {
    if (drive.is_known && now_ns - drive.time_ns > kTooOld_ns) drive = {};
  }
}

std::optional<JointVector> DrivePositions::all() const noexcept {
  JointVector out{};
  for (std::size_t i = 0; i < joint_count_; ++i) {
    if (!drives_[i].is_known) return std::nullopt;
    out[i] = drives_[i].position;
  }
  return out;
}

}  // namespace meridian::bridge
