// SPDX-License-Identifier: Apache-2.0
// Work frame, tools and soft limits as they are put in force: into the status and the recording.
#include "service/daemon/threads/telemetry_thread.hpp"

namespace meridian::interpolator {

bool TelemetryThread::take_set_up() noexcept {
  if (!ports_.set_up.for_telemetry.refresh()) return false;
  (void)ports_.set_up.telemetry_tools.try_take(tools_);
  put_in_force(ports_.set_up.for_telemetry.latest());
  return true;
}

void TelemetryThread::put_in_force(const SetUpInForce& in_force) noexcept {
  in_force_ = in_force;
  apply_set_up(model_, in_force);
  setup_.frame = in_force.sum;
  setup_.tools = in_force.tools;
  status_.work_frame = in_force.number;
  status_.frame = in_force.sum;
  status_.tools = in_force.tools;
  status_.limits = in_force.limits;
}

void TelemetryThread::record_frame(std::uint64_t cycle) noexcept {
  recorder_.take(
      record::RecordedFrame{cycle, in_force_.number, in_force_.origin_mm, in_force_.rotation});
}

/// Only the service's own file can hold a longer table: it was too long to be published.
void TelemetryThread::record_tools(std::uint64_t cycle) noexcept {
  constexpr std::size_t kMaxRecorded = 256;
  if (tools_.tools().size() > kMaxRecorded) return;
  if (tools_.tools().empty()) recorder_.take(record::RecordedTool{cycle, 0, 0, 0});
  for (const Tool& tool : tools_.tools()) {
    recorder_.take(
        record::RecordedTool{cycle, tool.number, tool.tip_length_mm(), tool.cutting_radius_mm()});
  }
}

void TelemetryThread::record_limits(std::uint64_t cycle) noexcept {
  const SoftLimits& limits = in_force_.soft_limits;
  if (limits.empty()) recorder_.take(record::RecordedLimits{cycle, 0, 0, 0, 0});
  for (std::uint32_t i = 0; i < kMaxJoints; ++i) {
    const SoftLimits::Row& row = limits.rows()[i];
    if (row.is_set) recorder_.take(record::RecordedLimits{cycle, i + 1, row.min, row.max, 0});
  }
  std::uint32_t number = 0;
  for (const KeepOutBox& box : limits.keep_out().boxes()) {
    ++number;
    for (std::uint32_t i = 0; i < kMaxJoints; ++i) {
      if (!box.has(static_cast<int>(i))) continue;
      recorder_.take(record::RecordedLimits{cycle, i + 1, box.min[i], box.max[i], number});
    }
  }
  const TipBox& tip = limits.tip_box();
  for (std::uint32_t i = 0; tip.is_set && i < tip.min.size(); ++i) {
    recorder_.take(
        record::RecordedLimits{cycle, i + 1, tip.min[i], tip.max[i], record::kTipBoxNumber});
  }
}

void TelemetryThread::record_set_up(Verb verb, std::uint64_t cycle) noexcept {
  if (verb == Verb::kFrame) record_frame(cycle);
  if (verb == Verb::kTool) record_tools(cycle);
  if (verb == Verb::kLimits) record_limits(cycle);
}

void TelemetryThread::confirm_set_up() noexcept {
  if (ports_.set_up.reported.load(std::memory_order_relaxed) == in_force_.change) return;
  ports_.set_up.status.store(status_.status_sequence, std::memory_order_relaxed);
  ports_.set_up.reported.store(in_force_.change, std::memory_order_release);
}

}  // namespace meridian::interpolator
