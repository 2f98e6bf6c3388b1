// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/supervisor/supervisor.hpp"

#include <cstring>
#include <utility>

#include "meridian/cycle/state_table.hpp"
#include "service/daemon/ports/monotonic.hpp"

namespace meridian::interpolator {
namespace {

/// Rings of the cycle cannot wake a DDS waitset: look at them so often.
constexpr auto kLookAtRings = std::chrono::milliseconds(2);
/// Of one topic at one look: a flood of it does not keep this thread from the others.
constexpr int kMaxSamples = 256;

}  // namespace

Supervisor::Supervisor(dds::Participant& participant, const MachineModel& model,
                       const ToolTable& tools, const config::ServiceConfig& service,
                       std::uint64_t service_id, const StatusClock& status_clock, Ports& ports,
                       telemetry::AuditLog* audit)
    : model_(model),
      own_tools_(tools),
      tools_(tools),
      service_(service),
      service_id_(service_id),
      status_clock_(status_clock),
      ports_(ports),
      audit_(audit),
      participant_(participant),
      commands_(participant, status_clock, ports),
      replies_(participant, ports),
      jogs_(participant),
      actions_done_(participant),
      actions_(participant),
      drives_(participant, model.joint_count, service_id, ports),
      enabling_(participant, service_id, ports),
      jog_intake_(service_id),
      waitset_(participant) {
  waitset_.attach(jogs_);
  waitset_.attach(actions_done_);
}

void Supervisor::run() noexcept {
  while (!ports_.is_stopping.load(std::memory_order_relaxed)) {
    refresh_view();
    ports_.drive_words.refresh();
    ports_.state.store(view_.record.state, std::memory_order_relaxed);
    ports_.may_leave.store(view_.record.state == State::kOff || view_.is_dry_run,
                           std::memory_order_relaxed);
    take_commands();
    take_enabling_changes();
    report_guard();
    take_jogs();
    take_actions_done();
    take_events();
    send_delayed_resets();
    work_on_set_up_change();
    work_on_switching_off();
    look_for_action_peer();
    waitset_.wait(kLookAtRings);
  }
}

void Supervisor::refresh_view() {
  if (!ports_.commands_view.refresh()) return;
  view_ = ports_.commands_view.latest();
  if (std::exchange(is_dry_run_, view_.is_dry_run) == view_.is_dry_run) return;
  if (is_dry_run_) {
    tool_before_ = in_spindle();
  } else {
    put_in_spindle(tool_before_);
  }
  looked_ns_ = 0;
  look_for_action_peer();
}

void Supervisor::switch_off() noexcept {
  is_switching_off_ = true;
  waitset_.wake();
}

void Supervisor::take_jogs() {
  if (view_.record.state != State::kJogging) jog_intake_.end();
  dds::Jog jog;
  dds::SampleInfo info;
  for (int left = kMaxSamples; left > 0 && jogs_.take(jog, info); --left) {
    if (!info.is_valid) continue;
    const std::uint64_t participant = senders_.participant_of(jogs_.handle(), info.source);
    const auto order =
        jog_intake_.take(jog, participant, view_.epoch, model_.joint_count,
                         ports_.spindle_tool_mm.load(std::memory_order_relaxed),
                         status_clock_.superseded_for(jog.status_seen, monotonic_ns()));
    if (order) ports_.jog.store(*order);
  }
}

void Supervisor::take_events() {
  Event event;
  bool has_session_event = false;
  while (ports_.events.try_pop(event)) {
    switch (event.code) {
      case EventCode::kAccepted:
      case EventCode::kRefused:
        answer(event);
        break;
      case EventCode::kActionDue:
        publish_action(event);
        break;
      case EventCode::kStateChanged:
        reported_state_ = static_cast<State>(event.a);
        break;
      case EventCode::kAlarm:
        // Asked again after a resume: what was answered to this time is no answer to that.
        if (static_cast<Alarm>(event.a) == Alarm::kActionFailed) close_action();
        break;
      case EventCode::kProgramEnd:
      case EventCode::kEpochAdvanced:
        close_action();
        action_ = {};
        // Nothing was planned while the drives were off: what waits in the queue stays good.
        event.b =
            event.code == EventCode::kEpochAdvanced && reported_state_ == State::kEnabling ? 1 : 0;
        has_session_event = ports_.session_events.try_push(event) || has_session_event;
        break;
      default:
        break;
    }
    if (!ports_.telemetry_events.try_push(event)) {
      ports_.events_overrun.fetch_add(1, std::memory_order_relaxed);
    }
  }
  if (has_session_event && notify_intake_) notify_intake_(has_action_peer_);
}

void Supervisor::publish_action(const Event& event) {
  const auto is_meant = [&event](const PlannedAction& planned) {
    return planned.epoch == event.epoch && planned.block.sequence == event.a;
  };
  // One that failed is asked for again after a resume.
  while (!is_meant(action_)) {
    if (!ports_.actions.try_pop(action_)) return;
  }
  is_action_open_ = true;
  // Of a dry run neither: no tool is changed where the machine only would be.
  if (service_.auxiliary == config::AuxiliaryPolicy::kIgnore || view_.is_dry_run) {
    if (action_.block.kind == BlockKind::kTool) {
      const Tool* tool = tools_.find(static_cast<int>(action_.block.value));
      if (tool != nullptr) {
        put_in_spindle({static_cast<std::uint32_t>(tool->number), tool->tip_length_mm()});
      }
    }
    settle_action(true);
    return;
  }
  const ClBlock& block = action_.block;
  if (block.kind == BlockKind::kTool) {
    const auto wait_ns = static_cast<std::int64_t>(1e9 * service_.action_timeout_s);
    tool_change_ = {action_id_ + 1, block.value, monotonic_ns() + wait_ns};
    ports_.is_tool_changing.store(true, std::memory_order_relaxed);
  }
  (void)actions_.write({.id = ++action_id_,
                        .service_id = service_id_,
                        .sequence = block.sequence,
                        .line = block.line,
                        .kind = block.action,
                        .value = block.value,
                        .text = std::string(block.text, ::strnlen(block.text, sizeof block.text))});
}

void Supervisor::take_actions_done() {
  dds::ActionDone done;
  for (int left = kMaxSamples; left > 0 && actions_done_.take(done); --left) {
    if (done.service_id != service_id_) continue;
    if (tool_change_.id != 0 && done.id == tool_change_.id) end_tool_change(done.is_done);
    if (is_action_open_ && done.id == action_id_) settle_action(done.is_done);
  }
  if (tool_change_.id != 0 && monotonic_ns() > tool_change_.until_ns) {
    ports_.is_tool_changing.store(false, std::memory_order_relaxed);
  }
}

/// A changer that was asked goes on when the program is aborted: what it ends with is in the
/// spindle. Of a dry run that began meanwhile it is what the spindle holds behind it.
void Supervisor::end_tool_change(bool is_done) {
  const Tool* tool = tools_.find(static_cast<int>(tool_change_.tool));
  if (is_done && tool != nullptr) {
    const SpindleTool changed{static_cast<std::uint32_t>(tool->number), tool->tip_length_mm()};
    if (is_dry_run_) {
      tool_before_ = changed;
    } else {
      put_in_spindle(changed);
    }
  }
  tool_change_ = {};
  ports_.is_tool_changing.store(false, std::memory_order_relaxed);
}

void Supervisor::close_action() {
  is_action_open_ = false;
  ports_.action_answer.store({});
}

void Supervisor::settle_action(bool is_done) {
  is_action_open_ = false;
  ports_.action_answer.store(
      {.sequence = action_.block.sequence, .is_answered = true, .is_done = is_done});
}

void Supervisor::look_for_action_peer() {
  constexpr std::int64_t kLook_ns = 100'000'000;
  if (monotonic_ns() - looked_ns_ < kLook_ns) return;
  looked_ns_ = monotonic_ns();
  const bool is_there =
      is_dry_run_ || (actions_.matched_readers() > 0 && actions_done_.matched_writers() > 0);
  if (std::exchange(has_action_peer_, is_there) != is_there && notify_intake_)
    notify_intake_(is_there);
}

/// Asks for the next step to Off, where there is one to ask for: a machine that is on its way there
/// (Aborting, FaultStop, Disabling) is waited for.
void Supervisor::work_on_switching_off() {
  constexpr std::int64_t kAskAgain_ns = 100'000'000;
  if (!is_switching_off_ || is_off_) return;
  const State state = view_.record.state;
  if (state == State::kOff || state == State::kFault) {
    is_off_ = true;
    return;
  }
  const std::int64_t now_ns = monotonic_ns();
  if (now_ns - asked_off_ns_ < kAskAgain_ns) return;
  asked_off_ns_ = now_ns;
  for (const Verb verb : {Verb::kDisable, Verb::kAbort}) {
    if (effect_of(state, verb).effect != Effect::kGo) continue;
    send_own(verb);
    return;
  }
}

}  // namespace meridian::interpolator
