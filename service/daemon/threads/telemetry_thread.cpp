// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/threads/telemetry_thread.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "meridian/cycle/state_table.hpp"
#include "meridian/cycle/supervise.hpp"
#include "meridian/units.hpp"
#include "service/daemon/ports/monotonic.hpp"
#include "service/recording/telemetry/log.hpp"
#include "service/recording/telemetry/words.hpp"

namespace meridian::interpolator {
namespace {

constexpr auto kBetweenLooks = std::chrono::milliseconds(10);

/// Whether an alarm that took the machine to Ready stands until it leaves it.
[[nodiscard]] bool stands_in_ready(Alarm alarm) noexcept {
  return alarm == Alarm::kHomingFailed || alarm == Alarm::kHomingTimeout ||
         alarm == Alarm::kNoContact;
}

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
  if (!in_force_.soft_limits.empty()) record_limits(0);
  while (!ports_.is_stopping.load(std::memory_order_relaxed)) {
    drain();
    // At once: after actions that are done at once, in a dry run, the way is begun as soon as it
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
  flight_.report_missed();
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
    log_->log(notice.kind == Notice::Kind::kWarning ? spdlog::level::warn : spdlog::level::info,
              "{}", notice.text.data());
    if (notice.kind == Notice::Kind::kNews) continue;
    if (status_.alarm == Alarm::kNone) status_.message = notice.text.data();
    notice_ = notice.kind == Notice::Kind::kOver ? "" : notice.text.data();
    has_news_ = true;
  }
  Event event;
  while (ports_.telemetry_events.try_pop(event)) {
    recorder_.take(event);
    flight_.take(event);
    const auto verb = static_cast<Verb>(event.b);
    if (event.code == EventCode::kAccepted && is_set_up(verb)) {
      has_news_ = take_set_up() || has_news_;
      record_set_up(verb, event.cycle);
    }
    report(event);
    keeper_.see(event, alarm_message_);
  }
  recorder_.miss_events(ports_.events_overrun.load(std::memory_order_relaxed));
  RelaxedAxis relaxed_axis;
  while (ports_.relaxed_axes.try_pop(relaxed_axis))
    log_->info("{}", telemetry::describe(relaxed_axis));
  Rewind rewind;
  while (ports_.rewinds.try_pop(rewind)) log_->info("{}", telemetry::describe(rewind));
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
  take_view();
  keeper_.set_dry_run(view_.is_dry_run);
  if (std::exchange(reported_state_, view_.record.state) != view_.record.state) has_news_ = true;
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

bool TelemetryThread::report_program() {
  const auto summary = program_.take();
  if (!summary) return false;
  const double period_s = 1e-9 * static_cast<double>(model_.cycle_ns);
  const std::string alarm = status_.alarm == Alarm::kNone ? "" : alarm_message_ + "; ";
  const std::size_t room = dds::kMaxText - std::min(dds::kMaxText, alarm.size());
  status_.message = alarm + describe(*summary, status_.program, period_s, room);
  log_->info("{}", describe(*summary, status_.program, period_s, SIZE_MAX));
  return true;
}

void TelemetryThread::report(const Event& event) {
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
      state_of_events_ = static_cast<State>(event.a);
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
      // That of a homing or a probing move stands until the machine does something else.
      if (stands_in_ready(status_.alarm) && static_cast<State>(event.b) == State::kReady) {
        status_.alarm = Alarm::kNone;
        has_news_ = true;
      }
      if (static_cast<State>(event.b) == State::kHeld) notice_.clear();
      if (!approach_.empty() && static_cast<State>(event.a) == State::kApproaching &&
          static_cast<State>(event.b) == State::kLoaded) {
        status_.message = approach_message_ = approach_;
      }
      break;
    case EventCode::kContactJoint:
    case EventCode::kContactFound:
      keep_contact(event);
      break;
    case EventCode::kStopped:
      status_.stop_time_s = 1e-9 * static_cast<double>(event.a);
      status_.stop_distance_mm = event.x;
      has_news_ = true;
      break;
    case EventCode::kEpochAdvanced:
      status_.blocks_done = 0;
      has_news_ = true;
      if (planned_approach_.epoch != event.a) forget_approach();  // of a program that is void
      break;
    case EventCode::kAccepted:
    case EventCode::kRefused:
      // Whoever is to move the machine again must have seen a status of after the stop.
      if (!is_stop(static_cast<Verb>(event.b))) break;
      has_news_ = true;
      if (event.code == EventCode::kAccepted) ++status_.stops;
      break;
    case EventCode::kPeriodsLost:
      periods_lost_ += event.a;  // logged once a second: a busy host loses many
      return;
    default:
      break;
  }
  const telemetry::Weight weight = telemetry::weight_of(event);
  if (weight == telemetry::Weight::kDetail) return;
  std::string words = telemetry::describe(event, model_);
  if (event.code == EventCode::kAlarm) alarm_message_ = words;
  words += silent_group(event);
  const bool is_reported_stop =
      event.code == EventCode::kStopped && status_.alarm == Alarm::kNone;  // else the reason stays
  if (event.code == EventCode::kAlarm) status_.message = words;
  // Why it stopped stays behind how it stopped.
  if (is_reported_stop) status_.message = notice_.empty() ? words : notice_ + "; " + words;
  log_->log(telemetry::level_of(weight), "cycle {}: {}", event.cycle, words);
}

void TelemetryThread::keep_contact(const Event& event) {
  if (event.code == EventCode::kContactFound) {
    ++status_.contacts;
    if (event.x != 0) ++status_.stops;  // whatever held the move, it was stopped
    status_.contact_periods = static_cast<std::uint32_t>(event.a);
    has_news_ = true;
    return;
  }
  JointVector& joints = event.b == 0 ? status_.contact_joints : status_.contact_free_joints;
  if (event.a < joints.size()) joints[event.a] = event.x;
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

void TelemetryThread::publish_latency(std::int64_t now_ns) {
  latency_ns_ = now_ns;
  if (periods_lost_ > 0) log_->warn("{} periods lost in the last second", periods_lost_);
  periods_lost_ = 0;
  flight_.report_missed();
  latency_.time_ns = now_ns;
  (void)latencies_.write(latency_);
}

}  // namespace meridian::interpolator
