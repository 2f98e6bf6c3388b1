// SPDX-License-Identifier: Apache-2.0
#include "service/panel/motion.hpp"

namespace meridian::panel {
namespace {

/// Frames are made 25 times a second; of a page that was silent for longer the rest is left out.
constexpr std::size_t kMaxTrail = 512, kMaxSamples = 1024;

/// Where the last rest of `setpoints` begins; 0: nothing rests in them.
[[nodiscard]] std::size_t last_rest(std::span<const Setpoint> setpoints) {
  for (std::size_t i = setpoints.size(); i-- > 1;) {
    if (setpoints[i].position == setpoints[i - 1].position) return i;
  }
  return 0;
}

}  // namespace

Motion::Motion(const MachineModel& model, int trail_every)
    : model_(model),
      trail_every_(trail_every),
      tool_length_mm_(model.tool_length_mm),
      shares_(model) {
  trail_.reserve(kMaxTrail);
  samples_.reserve(kMaxSamples);
}

void Motion::set_tool_length(double tool_length_mm) noexcept {
  if (tool_length_mm == tool_length_mm_) return;
  tool_length_mm_ = tool_length_mm;
  if (joints_) tip_ = forward(model_, tool_length_mm_, *joints_).tip;
}

void Motion::add(std::span<const Setpoint> setpoints, double tool_length_mm) {
  const bool is_changed = tool_length_mm != tool_length_mm_;
  const std::size_t change = is_changed ? last_rest(setpoints) : 0;
  for (const Setpoint& setpoint : setpoints.first(change)) add(setpoint);
  set_tool_length(tool_length_mm);
  for (const Setpoint& setpoint : setpoints.subspan(change)) add(setpoint);
}

void Motion::add(const Setpoint& setpoint) {
  if (joints_ && setpoint.cycle <= cycle_ && cycle_ - setpoint.cycle < kKept) return;
  const bool is_next = joints_ && setpoint.cycle == cycle_ + 1 && is_leading(setpoint.flags);
  cycle_ = setpoint.cycle;
  sent_[cycle_ % kKept] = {cycle_, setpoint.position};
  joints_ = stage::joints_of(model_.stage, setpoint.position);
  const bool is_fault = (setpoint.flags & kSetpointFaultStop) != 0;
  shares_.add(limited_of(model_, *joints_, setpoint.position), is_next,
              is_fault ? scene::Bounds::kOfFaultStop : scene::Bounds::kOfMotion);
  const Pose<double> pose = forward(model_, tool_length_mm_, *joints_);
  const double rate = 1e9 / static_cast<double>(model_.cycle_ns);
  const double feed = is_next ? rate * (pose.tip - tip_).norm() : 0;
  tip_ = pose.tip;
  if (samples_.size() < kMaxSamples) samples_.push_back({cycle_, *joints_, following_, feed});
  if (cycle_ % static_cast<std::uint64_t>(trail_every_) == 0 && trail_.size() < kMaxTrail) {
    trail_.push_back({pose, setpoint.line});
  }
}

void Motion::add_feedback(std::uint64_t cycle_seen, std::uint32_t joint_mask,
                          const JointVector& position) {
  const Sent& sent = sent_[cycle_seen % kKept];
  if (cycle_seen == 0 || sent.cycle != cycle_seen) return;
  for (std::size_t i = 0; i < position.size(); ++i) {
    if ((joint_mask >> i & 1U) != 0) following_[i] = sent.position[i] - position[i];
  }
}

void Motion::clear() {
  trail_.clear();
  samples_.clear();
  shares_.clear();
}

}  // namespace meridian::panel
