// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/planner_thread.hpp"

namespace meridian::interpolator {

PlannerThread::PlannerThread(const MachineModel& model, const ToolTable& tools, Ports& ports)
    : ports_(ports), writer_(ports.motion), planner_(model, tools) {}

void PlannerThread::run() noexcept {
  // The cycle cannot wake us when it makes room in its rings or comes to Ready: look again.
  constexpr std::int64_t kLookAgain_ns = 2'000'000, kIdle_ns = 50'000'000;
  while (!ports_.is_stopping.load(std::memory_order_relaxed)) {
    const std::uint32_t seen = ports_.planner_wake.look();
    if (work()) continue;
    ports_.planner_wake.wait(seen, ports_.blocks.empty() ? kIdle_ns : kLookAgain_ns);
  }
}

bool PlannerThread::work() noexcept {
  if (!is_in_step()) return false;
  const QueuedBlock* queued = ports_.blocks.peek(0);
  if (queued == nullptr) {
    if (has_begun_ && !is_refused_) planner_.advance(writer_);
    tell_eases();
    return false;
  }
  if (is_refused_) {
    pop();
    return true;
  }
  if (!has_begun_) {
    if (view_.record.state != State::kReady) return false;
    planner_.begin(view_.record.joints, ports_.spindle_tool_mm.load(std::memory_order_relaxed),
                   view_.epoch);
    published_before_s_ = writer_.published_s();
    has_begun_ = true;
  }
  return plan(*queued);
}

bool PlannerThread::is_in_step() noexcept {
  if (ports_.planner_view.refresh()) {
    const std::uint16_t epoch_before = view_.epoch;
    view_ = ports_.planner_view.latest();
    if (view_.epoch != epoch_before) has_begun_ = false;
  }
  const std::uint64_t voided = ports_.voided.load(std::memory_order_acquire);
  if (voided != voided_) {
    voided_ = voided;
    const std::uint64_t until = ports_.void_until.load(std::memory_order_relaxed);
    while (popped_ < until) pop();
    has_begun_ = false;
    is_refused_ = false;
  }
  return ports_.intake_epoch.load(std::memory_order_relaxed) == view_.epoch;
}

bool PlannerThread::plan(const QueuedBlock& queued) noexcept {
  if (!announce_action(queued.block)) return false;
  const PlanResult result = planner_.plan(queued.block, writer_);
  tell_eases();
  switch (result.status) {
    case PlanStatus::kNoRoom:
      return false;
    case PlanStatus::kOk:
      ports_.planned_s.store(writer_.published_s() - published_before_s_,
                             std::memory_order_relaxed);
      if (queued.block.kind == BlockKind::kEnd) has_begun_ = false;
      break;
    case PlanStatus::kRefused:
      is_refused_ = true;
      (void)ports_.rejects.try_push({queued.session, result.reject});
      break;
  }
  pop();
  return true;
}

void PlannerThread::tell_eases() noexcept {
  for (PoleEase ease; planner_.take_ease(ease);) (void)ports_.eases.try_push(ease);
}

bool PlannerThread::announce_action(const ClBlock& block) noexcept {
  const bool is_action = block.kind == BlockKind::kAuxiliary || block.kind == BlockKind::kTool ||
                         block.kind == BlockKind::kStop;
  if (!is_action || is_action_told_) return true;
  is_action_told_ = ports_.actions.try_push({view_.epoch, block});
  return is_action_told_;
}

void PlannerThread::pop() noexcept {
  ports_.blocks.drop(1);
  ++popped_;
  is_action_told_ = false;
}

}  // namespace meridian::interpolator
