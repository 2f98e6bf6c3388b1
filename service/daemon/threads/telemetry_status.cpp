// SPDX-License-Identifier: Apache-2.0
// The status that the telemetry thread publishes, and the words in it.
#include <algorithm>
#include <utility>

#include "meridian/cycle/state_table.hpp"
#include "meridian/cycle/supervise.hpp"
#include "meridian/units.hpp"
#include "service/daemon/threads/telemetry_thread.hpp"
#include "service/recording/telemetry/words.hpp"

namespace meridian::interpolator {

std::string TelemetryThread::silent_group(const Event& event) {
  if (event.code != EventCode::kAlarm || static_cast<Alarm>(event.a) != Alarm::kFeedbackLost) {
    return "";
  }
  if (ports_.drive_words_for_status.refresh()) words_ = ports_.drive_words_for_status.latest();
  const std::uint32_t mask = words_.oldest_mask;
  const bool is_reported = mask != 0 && first_bit(mask) == static_cast<int>(event.b);
  if (!is_reported && event.b != kNoJoint) return "";
  return "; drive group " + std::to_string(words_.oldest_group) + " is silent" +
         (is_reported ? ": " + telemetry::drive_names(mask, model_) : "");
}

bool TelemetryThread::take_approach() {
  if (!ports_.approach_for_status.refresh()) return false;
  planned_approach_ = ports_.approach_for_status.latest();
  approach_.clear();
  is_approach_new_ = planned_approach_.is_planned;
  if (!planned_approach_.is_planned) return false;
  approach_ = telemetry::describe(planned_approach_, model_, dds::kMaxText);
  const bool is_short = telemetry::is_short_of_clearance(planned_approach_, model_);
  log_->log(is_short ? spdlog::level::warn : spdlog::level::info, "{}",
            telemetry::describe(planned_approach_, model_, SIZE_MAX));
  return true;
}

void TelemetryThread::forget_approach() {
  if (status_.message == approach_message_) status_.message.clear();
  approach_.clear();
  is_approach_new_ = false;
}

std::string TelemetryThread::with_approach(const std::string& words) const {
  const State state = view_.record.state;
  const bool is_newer = state == State::kLoaded || state == State::kApproaching;
  const std::string front = words + "; ";
  if (!is_newer || approach_.empty() || front.size() >= dds::kMaxText) return words;
  const std::string both =
      front + telemetry::describe(planned_approach_, model_, dds::kMaxText - front.size());
  return both.size() <= dds::kMaxText ? both : words;
}

void TelemetryThread::say_what_is_new(const SessionView& session, bool has_reported_program) {
  (void)take_approach();
  bool is_declared = !std::exchange(is_approach_new_, false);
  const bool has_message = !session.message.empty() && session.message != session_message_;
  if (has_message) {
    session_message_ = session.message;
    log_->info("{}", session.message);
  }
  if (status_.alarm != Alarm::kNone) {
    // Of an alarm the operator needs reason and remedy first.
    const bool is_said = has_message && !has_reported_program;
    if (is_said) status_.message = alarm_message_ + "; " + session.message;
    return;
  }
  if (has_message && !has_reported_program) {
    status_.message = with_approach(session.message);
    if (status_.message != session.message) approach_message_ = status_.message, is_declared = true;
  }
  if (!is_declared) status_.message = approach_message_ = approach_;
}

/// The cycle shows its state at once, while its events come through the commands thread: the view
/// waits for them, so that no status has a state ahead of the alarm that led to it. Not for long,
/// for an event may be lost.
void TelemetryThread::take_view() {
  constexpr int kMaxLooks = 25;
  (void)ports_.telemetry_view.refresh();
  const CycleView& newest = ports_.telemetry_view.latest();
  const bool is_newer = newest.record.state != state_of_events_;
  const bool is_last = ports_.is_stopping.load(std::memory_order_relaxed);
  if (is_newer && !is_last && ++looks_ahead_ <= kMaxLooks) return;
  looks_ahead_ = 0;
  view_ = newest;
  state_of_events_ = newest.record.state;
}

void TelemetryThread::publish_status(std::int64_t now_ns) {
  const CycleRecord& record = view_.record;
  const SessionView session = intake_.view();
  dds::Status& status = status_;
  const bool is_other_session = status.session != session.session;
  const bool is_last = ports_.is_stopping.load(std::memory_order_relaxed);
  // Whoever hears that a session is over hears how its program went: the cycle that ended it is
  // among the records by now, its alarm among the events.
  if (is_other_session) drain();
  const bool has_reported_program = (is_other_session || is_last) && report_program();
  if (is_other_session && session.session != 0) {
    status.blocks_done = 0;
    note(telemetry::AuditKind::kSession, session.program, session);
  }
  if (status.state == State::kFault && record.state == State::kOff) status.alarm = Alarm::kNone;
  ++status.status_sequence;
  status.time_ns = now_ns;
  status.cycle = record.setpoint.cycle;
  status.state = record.state;
  status.epoch = view_.epoch;
  status.session = session.session;
  status.station = session.station;
  status.program = session.program;
  status.block_count = session.block_count;
  status.blocks_received = session.blocks_received;
  status.batches_dropped = session.batches_dropped;
  status.batches_lost = session.batches_lost;
  status.block = record.sequence;
  status.line = record.setpoint.line;
  status.motion = record.motion;
  status.branch = view_.branch;
  status.is_at_pole = view_.is_at_pole;
  status.feed_programmed_mm_per_min = units::per_min_from_per_s(view_.feed_mm_per_s);
  status.feed_achieved_mm_per_min = units::per_min_from_per_s(motion_.feed_mm_per_s());
  status.limiting_joint = is_on_path(record.state) ? motion_.limiting_joint() : -1;
  status.feed_override = view_.feed_override;
  status.rapid_override = view_.rapid_override;
  status.is_single_block = view_.is_single_block;
  status.stops_at_optional = view_.stops_at_optional;
  status.is_dry_run = view_.is_dry_run;
  status.rate = record.rate;
  status.plan_time_s = record.plan_time_s;
  status.joints = record.joints;
  status.tool = ports_.spindle_tool.load(std::memory_order_relaxed);
  status.tool_length_mm = ports_.spindle_tool_mm.load(std::memory_order_relaxed);
  if (ports_.drive_words_for_status.refresh()) words_ = ports_.drive_words_for_status.latest();
  status.drives_enabled_mask = words_.enabled_mask;
  status.drives_fault_mask = words_.fault_mask;
  status.probe = words_.probe;
  status.is_guard_open = words_.is_guard_open;
  status.blocks_queued = static_cast<std::uint32_t>(ports_.blocks.size());
  status.pieces_queued = static_cast<std::uint32_t>(ports_.motion.times.size());
  const bool is_begun = is_on_path(record.state) || is_in_program(record.state);
  const double done_s = is_begun ? record.plan_time_s : 0;
  status.planned_s = std::max(0.0, ports_.planned_s.load(std::memory_order_relaxed) - done_s);
  if (status.pieces_queued == 0) status.planned_s = 0;
  status.cycles_run = view_.cycles_run;
  status.periods_lost = view_.periods_lost;
  status.starvations = view_.starvations;
  status.setpoints_overrun = ports_.setpoints_overrun + ports_.writes_failed;
  status.records_overrun = ports_.records_overrun + recorder_.rows_lost();
  status.events_overrun = ports_.events_overrun + recorder_.events_lost();
  status.commands_dropped = ports_.commands_dropped;
  status.replies_dropped = ports_.replies_dropped;
  status.enabling_devices = static_cast<std::uint8_t>(ports_.enabling.pressed());
  if (ports_.stalled_reader.refresh()) {
    status.stalled_reader = ports_.stalled_reader.latest().name.data();
  }
  say_what_is_new(session, has_reported_program);
  // The clock first: a verb that quotes this status may be here before write() returns.
  status_clock_.published(status, now_ns);
  (void)statuses_.write(status);
  confirm_set_up();
  status_ns_ = now_ns;
  has_news_ = false;
  motion_.reset();
}

}  // namespace meridian::interpolator
