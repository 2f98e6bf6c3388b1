// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>

#include "meridian/cycle/state_table.hpp"
#include "service/daemon/ports/drive_words.hpp"
#include "service/daemon/ports/monotonic.hpp"
#include "service/daemon/supervisor/supervisor.hpp"
#include "service/recording/telemetry/reply_words.hpp"
#include "service/recording/telemetry/words.hpp"
#include "service/text/checksum.hpp"

/// Operators' commands: checked, passed to the cycle, answered.
namespace meridian::interpolator {
namespace {

constexpr std::int64_t kResetDrives_ns = 300'000'000;
/// Places for what waits to be answered that are kept for stops.
constexpr std::ptrdiff_t kStopSlots = 32;
/// Commands at one look: however many come, the rest of this thread's work is done between them.
constexpr int kMaxTaken = 1024;
const std::string kDry = "dry run: ", kStarted = "start accepted; ",
                  kTooMany = "too many commands at once; say it again";

}  // namespace

void Supervisor::take_commands() {
  Arrival arrival;
  for (int left = kMaxTaken; left > 0 && ports_.arrivals.try_pop(arrival); --left) {
    take_command(arrival);
  }
  ports_.commands.publish();
}

void Supervisor::take_command(const Arrival& arrival) {
  Pending command;
  command.key = arrival.key;
  command.participant = senders_.participant_of(commands_.reader(), arrival.source);
  command.source = arrival.source;
  command.request = {.request = arrival.request,
                     .operator_id = arrival.operator_id,
                     .operator_name = arrival.operator_name.data(),
                     .verb = arrival.verb,
                     .epoch_seen = arrival.epoch_seen,
                     .status_seen = arrival.status_seen,
                     .service_id_seen = arrival.service_id_seen,
                     .argument = arrival.argument,
                     .frame = {},
                     .tools_seen = 0,
                     .tool_file = {},
                     .limits = {}};
  if (arrival.verb == Verb::kFrame) command.request.frame = read_frame_order(arrival.key);
  if (arrival.verb == Verb::kLimits) command.request.limits = read_limits_order(arrival.key);
  if (arrival.verb == Verb::kTool) {
    tool_file_ = read_tool_file(arrival.key, command.request.tools_seen);
    command.tools = text::checksum_of(tool_file_.value_or(""));
  }
  const dds::CommandRequest& request = command.request;
  if (!is_within_quota(command.participant, arrival.source)) return;
  if (is_stop(request.verb)) return await_stop(command);
  if (is_repetition(command)) return;
  if (static_cast<int>(request.verb) >= kVerbCount) {
    reply(command, false, Refusal::kOutOfRange, "this service does not know that verb");
    return;
  }
  if (request.operator_id == 0) {
    reply(command, false, Refusal::kOutOfRange,
          "operator_id 0 names no operator: it must be drawn at random, and not 0");
    return;
  }
  // Whoever saw a status that is younger than the last look at the cycle is not late.
  refresh_view();
  const std::uint64_t rest = stream::rest_of(view_.record.state, view_.record.sequence);
  Refusal refusal = status_clock_.check(request, service_id_, view_.epoch, monotonic_ns(), rest);
  if (refusal == Refusal::kNone) refusal = check_turn(command);
  if (is_switching_off_ || refusal != Refusal::kNone) {
    const Refusal why = refusal != Refusal::kNone ? refusal : Refusal::kWrongState;
    reply(command, false, why,
          is_switching_off_ ? "the service is shutting down"
                            : telemetry::describe(request.verb, why, view_.record.state,
                                                  request.argument, model_));
    return;
  }
  const bool is_tool_jog = request.verb == Verb::kJog && request.argument >= kMaxJoints;
  if (is_tool_jog && ports_.is_tool_changing.load(std::memory_order_relaxed)) {
    reply(command, false, Refusal::kWrongState,
          "jog refused: which tool is in the spindle is not known, its change is not answered yet; "
          "jog a joint, or wait");
    return;
  }
  if (is_set_up(request.verb)) return begin_set_up_change(command);
  const State state = view_.record.state;
  const bool may_reset_drives =
      !view_.is_dry_run && (state == State::kFault || state == State::kOff);
  if (request.verb == Verb::kReset && may_reset_drives) return delay_reset(command);
  send(command);
}

bool Supervisor::is_within_quota(std::uint64_t participant, std::uint64_t source) {
  const ParticipantQuota::Result result = quota_.take(participant, monotonic_ns());
  if (result == ParticipantQuota::Result::kAllowed) return true;
  ports_.commands_dropped.fetch_add(1, std::memory_order_relaxed);
  if (result == ParticipantQuota::Result::kFirstBeyond) {
    notice("commands beyond 200 a second are dropped, stops alone are obeyed: " +
               dds::describe_source(participant_, commands_.reader(), source),
           Notice::Kind::kWarning);
  }
  return false;
}

/// What is said where it cannot be answered is in the log; the machine stops all the same.
void Supervisor::await_stop(const Pending& command) {
  if (Pending* const slot = find_slot(command.request.verb)) {
    *slot = command;
    return;
  }
  reply(command, false, Refusal::kWrongState,
        "too many stops at once to answer each; the machine stops all the same");
}

/// Whoever enables has not seen the dry run begin or end that is on its way to the cycle; and
/// whoever saw no status of after a stop sent his command before it, however late it came.
Refusal Supervisor::check_turn(const Pending& command) const noexcept {
  const dds::CommandRequest& request = command.request;
  if (request.verb == Verb::kEnable && is_pending(Verb::kDryRun)) return Refusal::kStale;
  if (is_set_up_stale(request)) return Refusal::kStale;
  if (is_guarded_off(request.verb)) return Refusal::kGuardOpen;
  if (lacks_enabling(request.verb)) return Refusal::kNoEnablingDevice;
  const std::uint64_t stop_status = ports_.stop_status.load(std::memory_order_acquire);
  const bool is_before_stop = request.status_seen <= stop_status;
  return leads_to_motion(request.verb) && is_before_stop ? Refusal::kOvertaken : Refusal::kNone;
}

bool Supervisor::is_guarded_off(Verb verb) const noexcept {
  const bool is_by_itself = leads_to_motion(verb) && verb != Verb::kEnable && verb != Verb::kJog;
  const bool is_open = ports_.is_guard_open.load(std::memory_order_relaxed);
  return is_by_itself && is_open && !view_.is_dry_run;
}

bool Supervisor::lacks_enabling(Verb verb) const noexcept {
  const bool moves = leads_to_motion(verb) && verb != Verb::kEnable;
  return moves && ports_.enabling.is_required() && ports_.enabling.pressed() == 0;
}

/// Whoever asks while one waits already waits with it.
void Supervisor::delay_reset(const Pending& command) {
  if (delayed_count_ == delayed_resets_.size()) {
    reply(command, false, Refusal::kWrongState, kTooMany);
    return;
  }
  if (delayed_count_ == 0) {
    drives_.reset_faults(monotonic_ns());
    delayed_until_ns_ = monotonic_ns() + kResetDrives_ns;
  }
  delayed_resets_[delayed_count_++] = command;
}

/// The same command of the same participant, to the letter: an operator's program that begins to
/// count anew, and one that quotes another's number, are no repetition.
bool Supervisor::is_repetition(const Pending& command) {
  const auto is_same = [&command](const Pending& other) {
    const dds::CommandRequest &a = other.request, &b = command.request;
    return other.participant == command.participant && a.operator_id == b.operator_id &&
           a.request == b.request && a.verb == b.verb && a.argument == b.argument &&
           a.status_seen == b.status_seen && a.epoch_seen == b.epoch_seen && a.frame == b.frame &&
           a.tools_seen == b.tools_seen && other.tools == command.tools && a.limits == b.limits;
  };
  if (command.request.operator_id == 0) return false;
  const auto answered =
      std::find_if(answered_.begin(), answered_.end(),
                   [&is_same](const Answered& other) { return is_same(other.command); });
  if (answered != answered_.end()) {
    push_reply(answered->reply);
    return true;
  }
  const auto waits = [&is_same](const Pending& pending) {
    return pending.key != 0 && is_same(pending);
  };
  const auto delayed_end = delayed_resets_.begin() + static_cast<std::ptrdiff_t>(delayed_count_);
  const bool is_being_set = set_up_phase_ != SetUpPhase::kNone && is_same(set_up_command_);
  return is_being_set || std::any_of(pending_.begin(), pending_.end(), waits) ||
         std::any_of(delayed_resets_.begin(), delayed_end, waits);
}

bool Supervisor::is_pending(Verb verb) const noexcept {
  return std::any_of(pending_.begin(), pending_.end(), [verb](const Pending& pending) {
    return pending.key != 0 && pending.request.verb == verb;
  });
}

void Supervisor::send_delayed_resets() {
  if (delayed_count_ == 0) return;
  const DriveWords& words = ports_.drive_words.latest();
  bool has_fault = false;
  for (int joint = 0; joint < model_.joint_count; ++joint) {
    const DriveState state = drive_state(words.statusword[static_cast<std::size_t>(joint)]);
    has_fault = has_fault || state == DriveState::kFault || state == DriveState::kFaultReaction;
  }
  if (has_fault && monotonic_ns() < delayed_until_ns_) return;
  for (std::size_t i = 0; i < delayed_count_; ++i) {
    delayed_resets_[i].key = ports_.commands.next_request();  // the cycle has had others meanwhile
    send(delayed_resets_[i]);
  }
  delayed_count_ = 0;
  ports_.commands.publish();
}

void Supervisor::send(const Pending& command) {
  const dds::CommandRequest& request = command.request;
  Pending* const slot = find_slot(request.verb);
  const bool is_sent = slot != nullptr && ports_.commands.stage({.request = command.key,
                                                                 .verb = request.verb,
                                                                 .argument = request.argument});
  if (is_sent) {
    *slot = command;
  } else {
    reply(command, false, Refusal::kWrongState, kTooMany);
  }
}

Supervisor::Pending* Supervisor::find_slot(Verb verb) noexcept {
  const auto is_free = [](const Pending& pending) { return pending.key == 0; };
  const auto free = std::count_if(pending_.begin(), pending_.end(), is_free);
  if (free <= (is_stop(verb) ? 0 : kStopSlots)) return nullptr;
  return &*std::find_if(pending_.begin(), pending_.end(), is_free);
}

void Supervisor::send_own(Verb verb) {
  ports_.commands.stage_stop(verb, ports_.commands.next_request());
}

/// Of stops of one verb that waited together the newest stands for all.
void Supervisor::answer(const Event& event) {
  const auto verb = static_cast<Verb>(event.b);
  take_commands();  // the cycle may have answered a stop before this thread heard of it
  if (!is_stop(verb)) give_up_older(event);
  for (Pending& pending : pending_) {
    const bool is_meant = pending.key == event.a ||
                          (is_stop(verb) && pending.request.verb == verb && pending.key < event.a);
    if (pending.key == 0 || !is_meant) continue;
    answer(event, pending);
    pending.key = 0;
  }
}

/// The cycle answers commands, as opposed to stops, in the order in which it received them. A
/// command whose answer was lost may have been carried out: a repetition of it is not.
void Supervisor::give_up_older(const Event& event) {
  for (Pending& pending : pending_) {
    const bool is_older = pending.key != 0 && pending.key < event.a;
    if (!is_older || is_stop(pending.request.verb)) continue;
    if (is_set_up(pending.request.verb)) {
      pending.key = 0;
      ask_cycle_for_set_up();  // once more: it makes no difference
      continue;
    }
    reply(pending, false, Refusal::kWrongState,
          "the machine's answer was lost: it may have been obeyed; look at the status");
    pending.key = 0;
  }
}

void Supervisor::answer(const Event& event, const Pending& pending) {
  refresh_view();
  const bool is_accepted = event.code == EventCode::kAccepted;
  const auto refusal = is_accepted ? Refusal::kNone : static_cast<Refusal>(event.x);
  const Verb verb = pending.request.verb;
  if (is_set_up(verb)) return answer_set_up(is_accepted, refusal);
  if (is_accepted && verb == Verb::kJog) {
    take_jogs();  // what came before is of the hand before
    jog_intake_.begin(pending.request.operator_id, pending.participant, pending.key);
  }
  std::string text = is_accepted ? what_happens(pending.request)
                                 : telemetry::describe(verb, refusal, view_.record.state,
                                                       pending.request.argument, model_);
  if (refusal == Refusal::kDriveContested) {
    text += ": " + telemetry::drive_names(ports_.drive_words.latest().contested_mask, model_);
  }
  reply(pending, is_accepted, refusal, text);
}

std::string Supervisor::what_happens(const dds::CommandRequest& request) {
  const bool is_declared = request.verb == Verb::kStart && ports_.approach.refresh();
  const Approach& approach = ports_.approach.latest();
  if (!is_declared || !approach.is_planned || approach.epoch != view_.epoch) {
    return telemetry::describe(request.verb, view_.record.state, request.argument);
  }
  const std::size_t taken = kStarted.size() + (view_.is_dry_run ? kDry.size() : 0);
  return kStarted + telemetry::describe(approach, model_, dds::kMaxText - taken);
}

void Supervisor::reply(const Pending& command, bool is_accepted, Refusal refusal,
                       const std::string& text) {
  const std::string said = is_accepted && view_.is_dry_run ? kDry + text : text;
  QueuedReply queued{.request = command.request.request,
                     .operator_id = command.request.operator_id,
                     .service_id = service_id_,
                     .requester = command.participant,
                     .verb = command.request.verb,
                     .is_accepted = is_accepted,
                     .refusal = refusal,
                     .state = view_.record.state,
                     .epoch = view_.epoch,
                     .text = {}};
  std::memcpy(queued.text.data(), said.data(), std::min(said.size(), queued.text.size() - 1));
  push_reply(queued);
  audit(command, queued);
  if (command.request.operator_id == 0 || is_stop(command.request.verb)) return;  // no repetitions
  answered_[answered_at_++ % answered_.size()] = {command, queued};
}

void Supervisor::audit(const Pending& command, const QueuedReply& queued) {
  if (audit_ == nullptr || !audit_->is_kept()) return;
  audit_->append({.identity = identity_of(command),
                  .operator_name = command.request.operator_name,
                  .operator_id = command.request.operator_id,
                  .request = command.request.request,
                  .verb = command.request.verb,
                  .argument = command.request.argument,
                  .is_accepted = queued.is_accepted,
                  .refusal = queued.refusal,
                  .state = queued.state,
                  .text = queued.text.data()});
}

const std::string& Supervisor::identity_of(const Pending& command) {
  const auto known = std::find_if(
      identities_.begin(), identities_.end(),
      [&command](const Identity& identity) { return identity.participant == command.participant; });
  if (known != identities_.end() && command.participant != 0) return known->name;
  Identity& identity = identities_[identities_at_++ % identities_.size()];
  identity = {command.participant,
              dds::describe_source(participant_, commands_.reader(), command.source)};
  return identity.name;
}

void Supervisor::push_reply(const QueuedReply& queued) {
  if (ports_.replies.try_push(queued)) {
    ports_.reply_wake.notify();
  } else {
    ports_.replies_dropped.fetch_add(1, std::memory_order_relaxed);
  }
}

}  // namespace meridian::interpolator
