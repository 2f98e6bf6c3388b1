// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "meridian/rt/state_table.hpp"
#include "service/interpolator/drive_words.hpp"
#include "service/interpolator/monotonic.hpp"
#include "service/interpolator/supervisor.hpp"
#include "service/telemetry/words.hpp"

/// Operators' verbs: judged, handed to the cycle, answered.
namespace meridian::interpolator {
namespace {

constexpr std::int64_t kResetDrives_ns = 300'000'000;
/// Places for what waits to be answered that are kept for stops.
constexpr std::ptrdiff_t kStopPlaces = 32;
/// Requests at one look: however many operators say, drives are looked after between them.
constexpr int kMostTaken = 1024;
const std::string kDry = "dry run: ", kStarted = "start accepted; ",
                  kTooMany = "too many commands at once; say it again";

}  // namespace

void Supervisor::take_commands() {
  int left = kMostTaken;
  while (take_burst(left)) {
  }
  ports_.commands.publish();  // no word before the stops that came with it
}

/// Judging and refusing take time: stops are on their way before any of it.
bool Supervisor::take_burst(int& left) {
  std::size_t count = 0;
  while (count < burst_.size() && left > 0 && commands_.take(burst_[count].request)) {
    --left;
    burst_[count].key = next_key_++;
    if (is_stop(burst_[count].request.verb)) {
      take_command(burst_[count]);
    } else {
      ++count;
    }
  }
  for (std::size_t i = 0; i < count; ++i) take_command(burst_[i]);
  return count == burst_.size();
}

void Supervisor::take_command(const Pending& command) {
  const dds::CommandRequest& request = command.request;
  if (has_come_before(request)) return;
  if (static_cast<int>(request.verb) >= kVerbCount) {
    reply(request, false, Refusal::kOutOfRange, "this service does not know that verb");
    return;
  }
  if (request.operator_id == 0 && !is_stop(request.verb)) {
    reply(request, false, Refusal::kOutOfRange,
          "operator_id 0 names no operator: it must be drawn at random, and not 0");
    return;
  }
  if (is_stop(request.verb)) stop_status_ = status_clock_.newest();
  // Whoever saw a status that is younger than the last look at the cycle is not late.
  refresh_view();
  const std::uint64_t rest = stream::rest_of(view_.record.state, view_.record.sequence);
  Refusal refusal = status_clock_.judge(request, service_id_, view_.epoch, monotonic_ns(), rest);
  if (refusal == Refusal::kNone) refusal = judge_turn(request);
  if (is_switching_off_ || refusal != Refusal::kNone) {
    const Refusal why = refusal != Refusal::kNone ? refusal : Refusal::kWrongState;
    reply(request, false, why,
          is_switching_off_ ? "the service is shutting down"
                            : telemetry::describe(request.verb, why, view_.record.state));
    return;
  }
  const bool is_tool_jog = request.verb == Verb::kJog && request.argument >= kMaxJoints;
  if (is_tool_jog && ports_.is_tool_changing.load(std::memory_order_relaxed)) {
    reply(request, false, Refusal::kWrongState,
          "jog refused: which tool is in the spindle is not known, its change is not answered yet; "
          "jog a joint, or wait");
    return;
  }
  const State state = view_.record.state;
  const bool may_reset_drives =
      !view_.is_dry_run && (state == State::kFault || state == State::kOff);
  if (request.verb == Verb::kReset && may_reset_drives) return delay_reset(command);
  send(command);
}

/// Whoever enables has not seen the dry run begin or end that is on its way to the cycle; and
/// whoever saw no status of after a stop said his word before it, however late it came.
Refusal Supervisor::judge_turn(const dds::CommandRequest& request) const noexcept {
  if (request.verb == Verb::kEnable && is_pending(Verb::kDryRun)) return Refusal::kStale;
  const bool is_before_stop = request.status_seen <= stop_status_;
  return leads_to_motion(request.verb) && is_before_stop ? Refusal::kOvertaken : Refusal::kNone;
}

/// Whoever says it while one waits already waits with it.
void Supervisor::delay_reset(const Pending& command) {
  if (delayed_count_ == delayed_resets_.size()) {
    reply(command.request, false, Refusal::kWrongState, kTooMany);
    return;
  }
  if (delayed_count_ == 0) {
    drives_.reset_faults(monotonic_ns());
    delayed_until_ns_ = monotonic_ns() + kResetDrives_ns;
  }
  delayed_resets_[delayed_count_++] = command;
}

/// Answers what was answered already again. Nobody, who may stop the machine, repeats nothing.
bool Supervisor::has_come_before(const dds::CommandRequest& request) {
  if (request.operator_id == 0) return false;
  const auto is_same = [&request](const auto& other) {
    return other.operator_id == request.operator_id && other.request == request.request;
  };
  const auto answered = std::find_if(answered_.begin(), answered_.end(), is_same);
  if (answered != answered_.end()) {
    (void)replies_.write(answered->reply);
    return true;
  }
  const auto waits = [&is_same](const Pending& pending) {
    return pending.key != 0 && is_same(pending.request);
  };
  const auto delayed_end = delayed_resets_.begin() + static_cast<std::ptrdiff_t>(delayed_count_);
  return std::any_of(pending_.begin(), pending_.end(), waits) ||
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
    delayed_resets_[i].key = next_key_++;  // others were told the cycle meanwhile
    send(delayed_resets_[i]);
  }
  delayed_count_ = 0;
  ports_.commands.publish();
}

void Supervisor::send(const Pending& command) {
  const dds::CommandRequest& request = command.request;
  const auto is_free = [](const Pending& pending) { return pending.key == 0; };
  const auto free = std::count_if(pending_.begin(), pending_.end(), is_free);
  const bool has_place = free > (is_stop(request.verb) ? 0 : kStopPlaces);
  const bool is_told =
      (has_place || is_stop(request.verb)) &&
      ports_.commands.stage(
          {.request = command.key, .verb = request.verb, .argument = request.argument});
  if (is_told && has_place) {
    *std::find_if(pending_.begin(), pending_.end(), is_free) = command;
    return;
  }
  if (command.is_own) return;
  reply(request, false, Refusal::kWrongState,
        is_told ? "too many stops at once to answer each; the machine was told of it all the same"
                : kTooMany);
}

/// Of stops of one verb that waited together the newest stands for all.
void Supervisor::answer(const Event& event) {
  const auto verb = static_cast<Verb>(event.b);
  if (!is_stop(verb)) give_up_older(event);
  for (Pending& pending : pending_) {
    const bool is_meant = pending.key == event.a ||
                          (is_stop(verb) && pending.request.verb == verb && pending.key < event.a);
    if (pending.key == 0 || !is_meant) continue;
    if (!pending.is_own) answer(event, pending);
    pending.key = 0;
  }
}

/// The cycle answers words, as opposed to stops, in the order in which they were told it. What was
/// lost of its answers may have been obeyed: it is not obeyed again where it is repeated.
void Supervisor::give_up_older(const Event& event) {
  for (Pending& pending : pending_) {
    const bool is_older = pending.key != 0 && pending.key < event.a;
    if (!is_older || is_stop(pending.request.verb)) continue;
    reply(pending.request, false, Refusal::kWrongState,
          "the machine's answer was lost: it may have been obeyed; look at the status");
    pending.key = 0;
  }
}

void Supervisor::answer(const Event& event, const Pending& pending) {
  refresh_view();
  const bool is_accepted = event.code == EventCode::kAccepted;
  const auto refusal = is_accepted ? Refusal::kNone : static_cast<Refusal>(event.x);
  const Verb verb = pending.request.verb;
  if (is_accepted && verb == Verb::kJog) {
    take_jogs();  // what came before is of the hand before
    jog_intake_.begin(pending.request.operator_id, pending.key);
  }
  std::string text =
      is_accepted ? what_happens(verb) : telemetry::describe(verb, refusal, view_.record.state);
  if (refusal == Refusal::kDriveContested) {
    text += ": " + telemetry::drive_names(ports_.drive_words.latest().contested_mask, model_);
  }
  reply(pending.request, is_accepted, refusal, text);
}

std::string Supervisor::what_happens(Verb verb) {
  const bool is_declared = verb == Verb::kStart && ports_.approach.refresh();
  const Approach& approach = ports_.approach.latest();
  if (!is_declared || !approach.is_planned || approach.epoch != view_.epoch) {
    return telemetry::describe(verb, view_.record.state);
  }
  const std::size_t taken = kStarted.size() + (view_.is_dry_run ? kDry.size() : 0);
  return kStarted + telemetry::describe(approach, model_, dds::kMostText - taken);
}

void Supervisor::reply(const dds::CommandRequest& request, bool is_accepted, Refusal refusal,
                       const std::string& text) {
  const dds::Reply reply{.request = request.request,
                         .operator_id = request.operator_id,
                         .service_id = service_id_,
                         .verb = request.verb,
                         .is_accepted = is_accepted,
                         .refusal = refusal,
                         .state = view_.record.state,
                         .epoch = view_.epoch,
                         .text = is_accepted && view_.is_dry_run ? kDry + text : text};
  (void)replies_.write(reply);
  if (request.operator_id == 0) return;  // never looked up
  answered_[answered_at_++ % answered_.size()] = {request.operator_id, request.request, reply};
}

}  // namespace meridian::interpolator
