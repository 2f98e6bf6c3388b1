// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/threads/cycle_thread.hpp"

#include <cerrno>
#include <ctime>
#include <limits>

#include "meridian/cycle/state_table.hpp"
#include "service/daemon/monitoring/set_up_jog.hpp"
#include "service/daemon/ports/monotonic.hpp"

namespace meridian::interpolator {
namespace {

void sleep_until(std::int64_t due_ns) noexcept {
  const timespec due{.tv_sec = due_ns / kSecond_ns, .tv_nsec = due_ns % kSecond_ns};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
  }
}

template <class Item, std::size_t N>
void push_or_count(SpscRing<Item, N>& ring, const Item& item,
                   std::atomic<std::uint64_t>& overrun) noexcept {
  if (!ring.try_push(item)) overrun.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

CycleThread::CycleThread(const MachineModel& model, const CycleOptions& options,
                         const monitoring::Limits& limits, Ports& ports) noexcept
    : model_(model),
      ports_(ports),
      state_(options, rate_bounds(model)),
      motion_(ports.motion),
      monitor_(limits, options.feedback_timeout_s),
      spans_(ports.spans != nullptr ? &ports.spans->cycle : nullptr) {}

void CycleThread::run() noexcept {
  motion_.set_epoch(state_.epoch);
  CycleClock clock(monotonic_ns(), model_.cycle_ns);
  while (!ports_.is_stopping.load(std::memory_order_relaxed)) {
    sleep_until(clock.next_due_ns());
    times_.woke_ns = monotonic_ns();
    gather(clock.woke_at(times_.woke_ns), times_.woke_ns);
    if (spans_.is_on()) times_.gathered_ns = monotonic_ns();
    step(model_, state_, motion_, inputs_, output_);
    hand_over();
    if (spans_.is_on()) report_spans();
  }
}

void CycleThread::gather(const Period& period, std::int64_t now_ns) noexcept {
  ports_.feedback.refresh();
  ports_.action_answer.refresh();
  ports_.jog.refresh();
  inputs_.feedback = ports_.feedback.latest();
  inputs_.action = ports_.action_answer.latest();
  inputs_.jog = ports_.jog.latest();
  inputs_.now_ns = now_ns;
  inputs_.due_ns = period.due_ns;
  inputs_.cycle = period.number;
  inputs_.lost_periods = period.lost;
  inputs_.computation_ns = computation_ns_;
  watch_enabling(now_ns);
  inputs_.tool_length_mm = ports_.spindle_tool_mm.load(std::memory_order_relaxed);
  watch_guard();
  inputs_.has_command = ports_.commands.try_pop(inputs_.command);
  inputs_.session = ports_.session.load(std::memory_order_relaxed);
  inputs_.monitoring = monitor_.check(model_, inputs_, output_.record, state_.is_dry_run,
                                      asked_of(state_.homing).mode_mask);
}

void CycleThread::hand_over() noexcept {
  times_.computed_ns = monotonic_ns();
  computation_ns_ = narrow_ns(times_.computed_ns - times_.woke_ns);
  show_drives_asked();
  push_or_count(ports_.setpoints, output_.record.setpoint, ports_.setpoints_overrun);
  ports_.publisher_wake.notify();
  times_.handed_ns = monotonic_ns();

  show();  // before the events: who hears of one sees at least the cycle that emitted it
  push_or_count(ports_.records, output_.record, ports_.records_overrun);
  for (std::size_t i = 0; i < output_.event_count; ++i) {
    const Event& event = output_.events[i];
    const bool is_accepted = event.code == EventCode::kAccepted;
    if (is_accepted && is_set_up(static_cast<Verb>(event.b))) take_set_up();
    push_or_count(ports_.events, event, ports_.events_overrun);
  }
  ports_.events_overrun.fetch_add(output_.events_dropped, std::memory_order_relaxed);
  (void)ports_.timings.try_push({.lateness = output_.record.lateness_ns,
                                 .computation = computation_ns_,
                                 .wake = narrow_ns(times_.handed_ns - times_.computed_ns),
                                 .lost = inputs_.lost_periods});
}

/// Between two programs: nothing that is planned by the set-up before runs any more.
void CycleThread::take_set_up() noexcept {
  if (ports_.set_up.for_cycle.refresh()) apply_set_up(model_, ports_.set_up.for_cycle.latest());
}

/// Ahead of the wake, so that the publisher passes it on in this very cycle.
void CycleThread::show_drives_asked() noexcept {
  const HomingAsked homing = asked_of(state_.homing);
  const DrivesAsked asked{is_enabled(output_.record.state) && !state_.is_dry_run, state_.epoch,
                          homing.mode_mask, homing.start_mask};
  if (asked == drives_asked_) return;
  drives_asked_ = asked;
  ports_.drives_asked.store(asked);
  ports_.drives_asked_changes.fetch_add(1, std::memory_order_release);
}

/// Whatever the transport, the commands thread or an operator does: the machine is held where its
/// enabling heartbeat is missing.
void CycleThread::watch_enabling(std::int64_t now_ns) noexcept {
  ports_.enabling.look(now_ns);
  const bool can_be_held = effect_of(state_.state, Verb::kHold).effect == Effect::kGo;
  if (!can_be_held || !ports_.enabling.holds_back()) return;
  ports_.commands.stage_stop(Verb::kHold, ports_.commands.next_request());
}

/// With an open guard the machine is jogged, and nothing else; a dry run moves nothing.
void CycleThread::watch_guard() noexcept {
  const bool is_open = inputs_.feedback.is_guard_open;
  ports_.is_guard_open.store(is_open, std::memory_order_relaxed);
  inputs_.max_jog_speed = std::numeric_limits<double>::infinity();
  if (!is_open || state_.is_dry_run) return;
  const monitoring::Limits& limits = monitor_.monitor().limits();
  inputs_.max_jog_speed = set_up_jog_speed(model_, limits, state_, inputs_.tool_length_mm);
  const bool can_be_held = effect_of(state_.state, Verb::kHold).effect == Effect::kGo;
  if (!can_be_held || state_.state == State::kJogging) return;
  ports_.commands.stage_stop(Verb::kHold, ports_.commands.next_request());
}

void CycleThread::report_spans() noexcept {
  using trace::Doing;
  const std::uint64_t cycle = inputs_.cycle;
  const std::int64_t first_due_ns = inputs_.due_ns - inputs_.lost_periods * model_.cycle_ns;
  spans_.stage(Doing::kWakeUp, first_due_ns, times_.woke_ns, cycle);
  spans_.stage(Doing::kGather, times_.woke_ns, times_.gathered_ns, cycle);
  spans_.stage(Doing::kStep, times_.gathered_ns, times_.computed_ns, cycle);
  spans_.stage(Doing::kWakeOther, times_.computed_ns, times_.handed_ns, cycle);
  spans_.stage(Doing::kShow, times_.handed_ns, monotonic_ns(), cycle);
  spans_.publish();
}

void CycleThread::show() noexcept {
  view_.record = output_.record;
  view_.epoch = state_.epoch;
  view_.alarm = state_.alarm;
  view_.feed_override = state_.feed_override;
  view_.rapid_override = state_.rapid_override;
  view_.is_single_block = state_.single_block.is_on;
  view_.stops_at_optional = state_.stops_at_optional;
  view_.is_dry_run = state_.is_dry_run;
  const TimePiece* piece = motion_.piece();
  const PathPiece* path = motion_.path();
  if (piece == nullptr) {
    view_.feed_mm_per_s = 0;
  } else if (piece->kind == TimeKind::kMove) {  // a rest between two motions has no feed of its own
    view_.feed_mm_per_s = piece->feed_mm_per_s;
  }
  view_.branch = path != nullptr ? path->branch : view_.branch;
  view_.is_at_pole = path != nullptr && path->kind == PathKind::kTurn;
  view_.homing = asked_of(state_.homing);
  ++view_.cycles_run;
  view_.periods_lost = state_.periods_lost;
  view_.starvations = state_.starvations;
  ports_.planner_view.store(view_);
  ports_.commands_view.store(view_);
  ports_.telemetry_view.store(view_);
}

}  // namespace meridian::interpolator
