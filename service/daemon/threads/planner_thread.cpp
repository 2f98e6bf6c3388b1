// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/threads/planner_thread.hpp"

#include "service/daemon/ports/monotonic.hpp"

namespace meridian::interpolator {

PlannerThread::PlannerThread(const MachineModel& model, const ToolTable& tools, Ports& ports)
    : ports_(ports),
      queue_(ports),
      writer_(ports.motion),
      model_(model),
      planner_(model_, tools),
      spans_(ports.spans != nullptr ? &ports.spans->planner : nullptr) {
  if (model.max_feed_override > 1) writer_.set_horizon(kFeedHorizon_s);
}

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
  const QueueFollower::Look look = queue_.look();
  if (look.is_emptied || look.is_new_epoch) has_begun_ = false;
  if (look.is_emptied) is_refused_ = is_action_reported_ = false;
  if (!look.is_in_step) return look.is_emptied;
  if (look.front == nullptr) {
    if (has_begun_) advance();
    report_plan();
    return false;
  }
  const bool is_cut_off = look.front->is_cut_off;
  if (is_cut_off && has_begun_) planner_.finish();
  if (is_refused_ || is_cut_off) {
    pop();
    return true;
  }
  if (!has_begun_) {
    const CycleView& view = queue_.view();
    if (view.record.state != State::kReady) return false;
    (void)ports_.session_settings.refresh();
    const SessionSettings& asked = ports_.session_settings.latest();
    if (asked.session != look.front->session) return false;  // the block is void by now
    // Set before the session was opened that sent this block.
    if (ports_.set_up.for_planner.refresh())
      apply_set_up(model_, ports_.set_up.for_planner.latest());
    if (ports_.set_up.planner_tools.try_take(spare_tools_)) planner_.swap_tools(spare_tools_);
    planner_.begin(view.record.joints, ports_.spindle_tool_mm.load(std::memory_order_relaxed),
                   view.epoch, asked.settings);
    writer_.forget_ahead();  // in Ready all that was published has run or is void
    published_before_s_ = writer_.published_s();
    report(Approach{});
    report_plan();  // that it begins, before anything of it can be started
    has_begun_ = true;
    look_ = 0;
  }
  return plan(*look.front);
}

void PlannerThread::advance() noexcept {
  look_at_stall();
  const std::int64_t begun_ns = spans_.is_on() ? monotonic_ns() : 0;
  const PlanResult result = planner_.advance(writer_);
  if (spans_.is_on()) spans_.write(trace::Doing::kAdvance, begun_ns, monotonic_ns(), 0);
  if (result.status == PlanStatus::kRefused && !is_refused_) refuse(result.reject);
}

void PlannerThread::look_at_stall() noexcept {
  constexpr std::int64_t kStall_ns = kSecond_ns;
  constexpr std::int64_t kLongest_ns = 5 * kSecond_ns;  // where it trickles and never stalls
  const std::uint64_t look = planner_.look();
  const bool is_other = look != look_;
  look_ = look;
  if (look == 0) return;
  const std::int64_t now_ns = monotonic_ns();
  if (is_other) looking_since_ns_ = last_block_ns_;
  const bool is_late =
      now_ns - last_block_ns_ > kStall_ns || now_ns - looking_since_ns_ > kLongest_ns;
  if (!is_late) return;
  planner_.look_no_further();
}

void PlannerThread::refuse(const BlockReject& reject) noexcept {
  is_refused_ = true;
  (void)ports_.rejects.try_push({session_, reject});
}

bool PlannerThread::plan(const QueuedBlock& queued) noexcept {
  session_ = queued.session;
  if (!announce_action(queued.block)) return false;
  const std::int64_t begun_ns = monotonic_ns();
  const PlanResult result = planner_.plan(queued.block, writer_);
  last_block_ns_ = monotonic_ns();
  planning_ns_ += last_block_ns_ - begun_ns;
  const bool has_room = result.status != PlanStatus::kNoRoom;
  spans_.write(has_room ? trace::Doing::kPlan : trace::Doing::kWaitForRoom, begun_ns,
               last_block_ns_, queued.block.sequence);
  if (has_room) {
    (void)ports_.plan_times.try_push(narrow_ns(planning_ns_));
    planning_ns_ = 0;
  }
  report_plan();
  switch (result.status) {
    case PlanStatus::kNoRoom:
      return false;
    case PlanStatus::kOk:
      if (queued.block.kind == BlockKind::kEnd) has_begun_ = false;
      break;
    case PlanStatus::kRefused:
      refuse(result.reject);
      break;
  }
  pop();
  return true;
}

void PlannerThread::report_plan() noexcept {
  ports_.planned_s.store(writer_.published_s() - published_before_s_, std::memory_order_relaxed);
  if (Approach approach; planner_.take_approach(approach)) report(approach);
  for (RelaxedAxis relaxed_axis; planner_.take_relaxed_axis(relaxed_axis);)
    (void)ports_.relaxed_axes.try_push(relaxed_axis);
  for (Rewind one; planner_.take_rewind(one);) (void)ports_.rewinds.try_push(one);
  for (FeedMark mark; planner_.take_feed_mark(mark);) {
    if (!ports_.feed_marks.try_push(mark)) ports_.events_overrun.fetch_add(1);
  }
}

void PlannerThread::report(const Approach& approach) noexcept {
  ports_.approach.store(approach);
  ports_.approach_for_status.store(approach);
}

bool PlannerThread::announce_action(const ClBlock& block) noexcept {
  const bool is_action = block.kind == BlockKind::kAuxiliary || block.kind == BlockKind::kTool ||
                         block.kind == BlockKind::kStop;
  if (!is_action || is_action_reported_) return true;
  is_action_reported_ = ports_.actions.try_push({queue_.view().epoch, block});
  return is_action_reported_;
}

void PlannerThread::pop() noexcept {
  queue_.pop();
  is_action_reported_ = false;
}

}  // namespace meridian::interpolator
