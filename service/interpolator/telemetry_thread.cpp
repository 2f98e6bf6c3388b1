// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/telemetry_thread.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "meridian/rt/state_table.hpp"
#include "meridian/rt/supervise.hpp"
#include "meridian/units.hpp"
#include "service/interpolator/monotonic.hpp"
#include "service/telemetry/log.hpp"
#include "service/telemetry/words.hpp"

namespace meridian::interpolator {
namespace {

constexpr auto kBetweenLooks = std::chrono::milliseconds(10);

/// As if an operator had said so ahead of the first cycle: what a replay begins with.
[[nodiscard]] Event optional_stop_on() noexcept {
  Event event;
  event.code = EventCode::kAccepted;
  event.b = static_cast<std::uint64_t>(Verb::kOptionalStop);
  event.x = 1;
  return event;
}

}  // namespace

TelemetryThread::TelemetryThread(dds::Participant& participant, const MachineModel& model,
                                 const config::ServiceConfig& service, std::uint64_t service_id,
                                 dds::RealtimeMode mode, Intake& intake, StatusClock& status_clock,
                                 telemetry::Recorder& recorder, telemetry::Journal& journal,
                                 telemetry::FlightRecorder& flight,
                                 std::shared_ptr<spdlog::logger> log, Ports& ports)
    : model_(model),
      service_(service),
      service_id_(service_id),
      intake_(intake),
      status_clock_(status_clock),
      recorder_(recorder),
      journal_(journal),
      flight_(flight),
      log_(std::move(log)),
      ports_(ports),
      statuses_(participant),
      latencies_(participant),
      motion_(model_) {
  status_.service_id = service_id_;
  status_.realtime_mode = mode;
  status_.is_secured = participant.is_secured();
  status_.is_open_network = participant.is_open_network();
  status_.is_enabling_required = service.deadman;
  latency_.service_id = service_id_;
  for (const char* name : kBooks) latency_.histograms.push_back({name, {}});
  status_.is_auxiliary_ignored = service.auxiliary == config::AuxiliaryPolicy::kIgnore;
}

void TelemetryThread::run() noexcept {
  const auto status_period_ns = static_cast<std::int64_t>(1e9 / service_.status_rate_hz);
  if (service_.optional_stop) recorder_.take(optional_stop_on());
  if (in_force_.sum != 0) record_frame(0);
  if (!tools_.tools().empty()) record_tools(0);
  while (!ports_.is_stopping.load(std::memory_order_relaxed)) {
    drain();
    // At once: behind actions that are done at once, in a dry run, the way is begun as soon as it
    // is planned.
    if (take_approach()) has_news_ = true;
    if (take_set_up()) has_news_ = true;
    const std::int64_t now_ns = monotonic_ns();
    keep_journal(now_ns);
    const bool is_due = has_news_ || now_ns - status_ns_ >= status_period_ns;
    if (is_due && view_.cycles_run > 0) publish_status(now_ns);
    if (now_ns - latency_ns_ >= kSecond_ns) publish_latency(now_ns);
    std::this_thread::sleep_for(kBetweenLooks);
  }
  drain();
  keep_journal(monotonic_ns());
  flight_.finish();
  flight_.tell_missed();
  publish_status(monotonic_ns());
}

void TelemetryThread::keep_journal(std::int64_t now_ns) {
  if (!keeper_.is_due()) return;
  const SessionView session = intake_.view();
  telemetry::JournalKeeper::Owner owner{session.session, session.station, session.program,
                                        session.options};
  owner.file_checksum = session.file_checksum;
  owner.from_line = session.from_line;
  owner.setup = setup_;
  owner.setup.tool_mm = ports_.spindle_tool_mm.load(std::memory_order_relaxed);
  owner.is_line_end = intake_.is_line_end(session.session, keeper_.block());
  const std::int64_t time_ns =
      std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
  auto entry = keeper_.due(owner, now_ns, time_ns);
  if (entry) {
    journal_.take(*entry);
  } else {
    entry = keeper_.due_position(owner, time_ns);
    if (entry) journal_.take_position(*entry);
  }
  if (entry && last_ != nullptr) last_->set(*entry);
}

void TelemetryThread::drain() {
  keeper_.set_move(intake_.view().is_move);  // ahead of its events
  // The planner first: a plan is begun before its program is started.
  for (FeedMark mark; ports_.feed_marks.try_pop(mark);) {
    Event planned;
    planned.code = mark.is_begin ? EventCode::kPlanBegun : EventCode::kFeedPlanned;
    planned.cycle = view_.record.setpoint.cycle;
    planned.a = mark.sequence;
    planned.b = mark.span;
    planned.x = mark.is_begin ? mark.tool_length_mm : mark.factor;
    if (mark.looked_at > 0) {
      planned.code = EventCode::kPlanLooked;
      planned.a = mark.looked_at;
      planned.b = mark.sequence;
      planned.x = mark.is_late ? 1 : 0;
      log_->log(mark.is_late ? spdlog::level::warn : spdlog::level::info, "{}",
                telemetry::describe(planned, model_));
    }
    recorder_.take(planned);
  }
  for (Notice notice; ports_.notices.try_pop(notice);) {
    log_->log(notice.is_warning ? spdlog::level::warn : spdlog::level::info, "{}",
              notice.text.data());
    if (!notice.is_for_status) continue;
    notice_ = notice.text.data();
    if (status_.alarm == Alarm::kNone) status_.message = notice_;
    has_news_ = true;
  }
  Event event;
  while (ports_.told.try_pop(event)) {
    recorder_.take(event);
    flight_.take(event);
    const bool is_set_up = event.code == EventCode::kAccepted &&
                           (static_cast<Verb>(event.b) == Verb::kFrame ||
                            static_cast<Verb>(event.b) == Verb::kTool);
    if (is_set_up) {
      has_news_ = take_set_up() || has_news_;
      const bool is_frame = static_cast<Verb>(event.b) == Verb::kFrame;
      is_frame ? record_frame(event.cycle) : record_tools(event.cycle);
    }
    tell(event);
    keeper_.see(event, alarm_message_);
  }
  recorder_.miss_events(ports_.events_overrun.load(std::memory_order_relaxed));
  PoleEase ease;
  while (ports_.eases.try_pop(ease)) log_->info("{}", telemetry::describe(ease));
  Unwinding unwinding;
  while (ports_.unwindings.try_pop(unwinding)) log_->info("{}", telemetry::describe(unwinding));
  drain_records();
  CycleTiming timing;
  while (ports_.timings.try_pop(timing)) {
    const std::int64_t late_ns = timing.lateness + timing.lost * model_.cycle_ns;
    book(kLateness).record_every(late_ns, model_.cycle_ns);
    book(kComputation).record(timing.computation);
    book(kWake).record(timing.wake);
  }
  PublishTiming sent;
  while (ports_.publish_timings.try_pop(sent)) {
    book(kSent).record(sent.sent_minus_due);
    book(kWrite).record(sent.write);
  }
  std::int32_t took_ns = 0;
  while (ports_.plan_times.try_pop(took_ns)) book(kPlanning).record(took_ns);
  while (ports_.round_trips.try_pop(took_ns)) book(kRoundTrip).record(took_ns);
  if (ports_.telemetry_view.refresh()) view_ = ports_.telemetry_view.latest();
  keeper_.set_dry_run(view_.is_dry_run);
  if (std::exchange(told_state_, view_.record.state) != view_.record.state) has_news_ = true;
}

void TelemetryThread::drain_records() {
  CycleRecord record;
  const double tool_mm = ports_.spindle_tool_mm.load(std::memory_order_relaxed);
  while (ports_.records.try_pop(record)) {
    (void)recorder_.take(record);
    // What the drives had said by the time the cycle woke goes with it.
    const std::int64_t woke_ns = record.setpoint.due_ns + record.lateness_ns;
    for (const record::DriveReport* report = ports_.drive_reports.peek(0);
         report != nullptr && report->arrival_ns <= woke_ns;
         report = ports_.drive_reports.peek(0)) {
      flight_.take(*report);
      keeper_.see_taken(report->cycle_seen);
      ports_.drive_reports.drop(1);
    }
    flight_.take(record);
    motion_.see(record, tool_mm);
    program_.see(record, view_.feed_override, view_.rapid_override);
  }
}

bool TelemetryThread::take_set_up() noexcept {
  if (!ports_.set_up.for_telemetry.refresh()) return false;
  (void)ports_.set_up.telemetry_tools.try_take(tools_);
  put_in_force(ports_.set_up.for_telemetry.latest());
  return true;
}

void TelemetryThread::put_in_force(const SetUpInForce& in_force) noexcept {
  in_force_ = in_force;
  place(model_, in_force);
  setup_.frame = in_force.sum;
  setup_.tools = in_force.tools;
  status_.work_frame = in_force.number;
  status_.frame = in_force.sum;
  status_.tools = in_force.tools;
}

void TelemetryThread::record_frame(std::uint64_t cycle) noexcept {
  recorder_.take(record::RecordedFrame{cycle, in_force_.number, in_force_.origin_mm,
                                       in_force_.rotation});
}

/// A table that is longer comes from the service's own file alone: it was too long to be told.
void TelemetryThread::record_tools(std::uint64_t cycle) noexcept {
  constexpr std::size_t kMaxRecorded = 256;
  if (tools_.tools().size() > kMaxRecorded) return;
  if (tools_.tools().empty()) recorder_.take(record::RecordedTool{cycle, 0, 0, 0});
  for (const Tool& tool : tools_.tools()) {
    recorder_.take(record::RecordedTool{cycle, tool.number, tool.tip_length_mm(),
                                        tool.cutting_radius_mm()});
  }
}

void TelemetryThread::tell_set_up_told() noexcept {
  if (ports_.set_up.told.load(std::memory_order_relaxed) == in_force_.change) return;
  ports_.set_up.status.store(status_.status_sequence, std::memory_order_relaxed);
  ports_.set_up.told.store(in_force_.change, std::memory_order_release);
}

bool TelemetryThread::tell_program() {
  const auto summary = program_.take();
  if (!summary) return false;
  const double period_s = 1e-9 * static_cast<double>(model_.cycle_ns);
  const std::string alarm = status_.alarm == Alarm::kNone ? "" : alarm_message_ + "; ";
  const std::size_t room = dds::kMostText - std::min(dds::kMostText, alarm.size());
  status_.message = alarm + describe(*summary, status_.program, period_s, room);
  log_->info("{}", describe(*summary, status_.program, period_s, SIZE_MAX));
  return true;
}

void TelemetryThread::tell(const Event& event) {
  switch (event.code) {
    case EventCode::kBlockDone:
      ++status_.blocks_done;
      break;
    case EventCode::kAlarm:
      status_.alarm = static_cast<Alarm>(event.a);
      status_.alarm_joint = static_cast<std::uint8_t>(event.b);
      status_.alarm_line = event.line;
      status_.alarm_value = event.x;
      has_news_ = true;
      break;
    case EventCode::kStateChanged:
      if (static_cast<State>(event.a) == State::kFault) {
        note(telemetry::AuditKind::kFault, alarm_message_, intake_.view());
      }
      // Those of faults end with Fault, however soon the next enable follows the reset.
      if (static_cast<State>(event.b) == State::kFault) {
        status_.alarm = Alarm::kNone;
        has_news_ = true;
      }
      // That of a failed action holds the program, no longer.
      if (status_.alarm == Alarm::kActionFailed && static_cast<State>(event.a) != State::kHeld) {
        status_.alarm = Alarm::kNone;
        has_news_ = true;
      }
      // That of a homing stands until the machine does something else.
      if ((status_.alarm == Alarm::kHomingFailed || status_.alarm == Alarm::kHomingTimeout) &&
          static_cast<State>(event.b) == State::kReady) {
        status_.alarm = Alarm::kNone;
        has_news_ = true;
      }
      if (static_cast<State>(event.b) == State::kHeld) notice_.clear();
      if (!approach_.empty() && static_cast<State>(event.a) == State::kApproaching &&
          static_cast<State>(event.b) == State::kLoaded) {
        status_.message = approach_message_ = approach_;
      }
      break;
    case EventCode::kStopped:
      status_.stop_time_s = 1e-9 * static_cast<double>(event.a);
      status_.stop_distance_mm = event.x;
      has_news_ = true;
      break;
    case EventCode::kEpochAdvanced:
      status_.blocks_done = 0;
      has_news_ = true;
      if (way_.epoch != event.a) forget_approach();  // of a program that is void
      break;
    case EventCode::kAccepted:
    case EventCode::kRefused:
      // Whoever is to move the machine again must have seen a status of after the stop.
      if (is_stop(static_cast<Verb>(event.b))) has_news_ = true;
      break;
    case EventCode::kPeriodsLost:
      periods_lost_ += event.a;  // told once a second: a busy host loses many
      return;
    default:
      break;
  }
  const telemetry::Weight weight = telemetry::weight_of(event);
  if (weight == telemetry::Weight::kDetail) return;
  std::string words = telemetry::describe(event, model_);
  if (event.code == EventCode::kAlarm) alarm_message_ = words;
  words += silent_group(event);
  const bool is_told_stop =
      event.code == EventCode::kStopped && status_.alarm == Alarm::kNone;  // else the reason stays
  if (event.code == EventCode::kAlarm) status_.message = words;
  // Why it stopped stays behind how it stopped.
  if (is_told_stop) status_.message = notice_.empty() ? words : notice_ + "; " + words;
  log_->log(telemetry::level_of(weight), "cycle {}: {}", event.cycle, words);
}

std::string TelemetryThread::silent_group(const Event& event) {
  if (event.code != EventCode::kAlarm || static_cast<Alarm>(event.a) != Alarm::kFeedbackLost) {
    return "";
  }
  if (ports_.drive_words_for_status.refresh()) words_ = ports_.drive_words_for_status.latest();
  const std::uint32_t mask = words_.oldest_mask;
  const bool is_told = mask != 0 && first_bit(mask) == static_cast<int>(event.b);
  if (!is_told && event.b != kNoJoint) return "";
  return "; drive group " + std::to_string(words_.oldest_group) + " is silent" +
         (is_told ? ": " + telemetry::drive_names(mask, model_) : "");
}

bool TelemetryThread::take_approach() {
  if (!ports_.approach_for_status.refresh()) return false;
  way_ = ports_.approach_for_status.latest();
  approach_.clear();
  is_approach_new_ = way_.is_planned;
  if (!way_.is_planned) return false;
  approach_ = telemetry::describe(way_, model_, dds::kMostText);
  const bool is_short = telemetry::is_short_of_clearance(way_, model_);
  log_->log(is_short ? spdlog::level::warn : spdlog::level::info, "{}",
            telemetry::describe(way_, model_, SIZE_MAX));
  return true;
}

void TelemetryThread::forget_approach() {
  if (status_.message == approach_message_) status_.message.clear();
  approach_.clear();
  is_approach_new_ = false;
}

std::string TelemetryThread::with_approach(const std::string& words) const {
  const State state = view_.record.state;
  const bool is_ahead = state == State::kLoaded || state == State::kApproaching;
  const std::string front = words + "; ";
  if (!is_ahead || approach_.empty() || front.size() >= dds::kMostText) return words;
  const std::string both = front + telemetry::describe(way_, model_, dds::kMostText - front.size());
  return both.size() <= dds::kMostText ? both : words;
}

void TelemetryThread::say_what_is_new(const SessionView& session, bool has_told_program) {
  (void)take_approach();
  bool is_declared = !std::exchange(is_approach_new_, false);
  const bool has_message = !session.message.empty() && session.message != session_message_;
  if (has_message) {
    session_message_ = session.message;
    log_->info("{}", session.message);
  }
  if (status_.alarm != Alarm::kNone) {
    // Of an alarm the operator needs reason and remedy first.
    const bool is_said = has_message && !has_told_program;
    if (is_said) status_.message = alarm_message_ + "; " + session.message;
    return;
  }
  if (has_message && !has_told_program) {
    status_.message = with_approach(session.message);
    if (status_.message != session.message) approach_message_ = status_.message, is_declared = true;
  }
  if (!is_declared) status_.message = approach_message_ = approach_;
}

void TelemetryThread::note(telemetry::AuditKind kind, const std::string& text,
                           const SessionView& session) {
  if (audit_ == nullptr) return;
  telemetry::AuditEntry entry;
  entry.kind = kind;
  entry.identity = session.identity;
  entry.operator_name = session.station;
  entry.state = kind == telemetry::AuditKind::kFault ? State::kFault : view_.record.state;
  entry.text = text;
  audit_->append(std::move(entry));
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
  const bool has_told_program = (is_other_session || is_last) && tell_program();
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
  say_what_is_new(session, has_told_program);
  // The clock first: a verb that quotes this status may be here before write() returns.
  status_clock_.published(status, now_ns);
  (void)statuses_.write(status);
  tell_set_up_told();
  status_ns_ = now_ns;
  has_news_ = false;
  motion_.reset();
}

void TelemetryThread::publish_latency(std::int64_t now_ns) {
  latency_ns_ = now_ns;
  if (periods_lost_ > 0) log_->warn("{} periods lost in the last second", periods_lost_);
  periods_lost_ = 0;
  flight_.tell_missed();
  latency_.time_ns = now_ns;
  (void)latencies_.write(latency_);
}

}  // namespace meridian::interpolator
