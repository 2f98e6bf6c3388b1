// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/intake.hpp"

#include <algorithm>

#include "service/daemon/ports/monotonic.hpp"
#include "service/transport/sources.hpp"

namespace meridian::interpolator {
namespace {

constexpr auto kIdle = std::chrono::milliseconds(10);
/// Of one topic at one look: a flood of it does not keep this thread from its other work.
constexpr int kMaxSamples = 512;
constexpr std::int64_t kLookForStation_ns = 200'000'000;

/// What a session asks the planner for.
SmoothSettings settings_of(const dds::SessionRequest& request) {
  SmoothSettings settings;
  settings.transition = stream::transition_asked(request);
  settings.tip_tolerance_mm = request.tip_tolerance_mm;
  settings.axis_tolerance_rad = request.axis_tolerance_rad;
  settings.retracts_first = (request.policies & dds::kPolicyRetractFirst) != 0;
  settings.ends_exactly = (request.policies & dds::kPolicyMove) != 0;
  if ((request.policies & dds::kPolicyFirstJoints) != 0) {
    settings.first_joints = request.first_joints;
  }
  return settings;
}

}  // namespace

Intake::Intake(dds::Participant& participant, const MachineModel& model,
               const stream::ToolLengths& tools, const config::ServiceConfig& service,
               std::uint64_t service_id, Ports& ports)
    : participant_(participant),
      ports_(ports),
      service_(service),
      model_(model),
      check_(model_, tools, service_id),
      batches_(participant),
      requests_(participant),
      credits_(participant),
      waitset_(participant),
      spans_(ports.spans != nullptr ? &ports.spans->intake : nullptr) {
  waitset_.attach(batches_);
  waitset_.attach(requests_);
}

void Intake::run() noexcept {
  while (!ports_.is_stopping.load(std::memory_order_relaxed)) {
    take_events();
    take_rejects();
    take_requests();
    take_batches();
    show_cut_off();
    look_for_station();
    free_idle_machine();
    publish(check_.due_credit(context()));
    show();
    waitset_.wait(kIdle);
  }
}

stream::IntakeContext Intake::context() noexcept {
  const auto limit = static_cast<std::size_t>(service_.block_queue);
  const std::size_t used = ports_.blocks.size() + kReserve;
  const std::size_t slots = std::min(ports_.blocks.capacity(), limit);
  return {.now_ns = monotonic_ns(),
          .free_slots = slots > used ? slots - used : 0,
          .actions = {.is_there = has_action_peer_,
                      .is_ignored = service_.auxiliary == config::AuxiliaryPolicy::kIgnore},
          .is_tool_known = !ports_.is_tool_changing.load(std::memory_order_relaxed)};
}

void Intake::take_events() {
  Event event;
  while (ports_.session_events.try_pop(event)) {
    if (event.code == EventCode::kProgramEnd) {
      publish(check_.on_program_end(context()));
    } else if (event.b == 1) {
      mark_.epoch = static_cast<std::uint16_t>(event.a);
      show_mark();
    } else {
      empty_queue(static_cast<std::uint16_t>(event.a));
      publish(check_.on_queues_emptied("the operator, the probe or a fault ended the program",
                                       context()));
    }
  }
}

void Intake::empty_queue(std::uint16_t epoch) noexcept {
  mark_ = {pushed_, epoch};
  show_mark();
}

void Intake::show_mark() noexcept {
  ports_.queue_mark.store(mark_);
  ports_.planner_wake.notify();
}

void Intake::take_rejects() {
  SessionReject refused;
  while (ports_.rejects.try_pop(refused)) {
    if (refused.session != check_.session()) continue;
    publish(check_.on_planner_reject(refused.reject, context()));
  }
}

/// A refused program whose blocks have all run, or never could, leaves a machine in Ready with
/// nothing to do: it is free then.
void Intake::free_idle_machine() {
  // Longer than the planner waits for more blocks to look at before it begins with what is there.
  constexpr std::int64_t kIdle_ns = 1'500'000'000;
  const bool is_idle = refused_session_ != 0 && refused_session_ == check_.session() &&
                       ports_.state.load(std::memory_order_relaxed) == State::kReady &&
                       ports_.blocks.empty() && ports_.motion.times.empty();
  if (!is_idle) {
    idle_since_ns_ = 0;
    return;
  }
  const std::int64_t now_ns = monotonic_ns();
  if (idle_since_ns_ == 0) idle_since_ns_ = now_ns;
  if (now_ns - idle_since_ns_ < kIdle_ns) return;
  empty_queue(mark_.epoch);
  publish(check_.on_queues_emptied("nothing of the program is left to run", context()));
}

void Intake::take_requests() {
  dds::SessionRequest request;
  dds::SampleInfo info;
  for (int left = kMaxSamples; left > 0 && requests_.take(request, info); --left) {
    if (info.is_valid && is_within_quota(info.source)) take_request(request, info.source);
  }
}

void Intake::take_request(const dds::SessionRequest& request, std::uint64_t source) {
  if (!may_open(request) || !may_go_on(request)) return;
  const std::uint64_t before = check_.session();
  publish(check_.on_request(request, context(),
                            ports_.spindle_tool_mm.load(std::memory_order_relaxed)));
  if (check_.session() != request.session || !check_.is_held()) return;
  if (station_source_ != source) {
    station_identity_ = dds::describe_source(participant_, requests_.handle(), source);
  }
  station_source_ = source;
  is_station_there_ = true;
  if (before != request.session) begin_session(request);
}

/// The claim is given back in show() where no session comes of it.
bool Intake::may_open(const dds::SessionRequest& request) {
  if (request.request != dds::SessionRequestKind::kOpen || check_.is_held()) return true;
  if (!ports_.set_up.claim.try_take(ProgramClaim::Holder::kSession)) {
    publish(check_.refuse_program(request, "the set-up is being changed; stream it again"));
    return false;
  }
  if (ports_.set_up.for_intake.refresh()) put_in_force(ports_.set_up.for_intake.latest());
  if (ToolTable tools; ports_.set_up.intake_tools.try_take(tools)) check_.set_tools(tools);
  std::string stale;
  if (request.frame != 0 && request.frame != in_force_.sum) {
    stale = "stale: the program was checked under another work frame than number " +
            std::to_string(in_force_.number) + ", which is in force now; stream it again";
  } else if (request.tools != 0 && request.tools != in_force_.tools) {
    stale =
        "stale: the program was checked with another tool table than the one that is in force "
        "now; stream it again";
  } else if (request.limits != 0 && request.limits != in_force_.limits) {
    stale =
        "stale: the program was checked under other soft limits than those that are in force now; "
        "stream it again";
  }
  if (!stale.empty()) publish(check_.refuse_program(request, stale));
  return stale.empty();
}

void Intake::put_in_force(const SetUpInForce& in_force) noexcept {
  in_force_ = in_force;
  apply_set_up(model_, in_force);
  setup_.frame = in_force.sum;
  setup_.tools = in_force.tools;
}

/// Who opens session after session is not answered each time; his blocks and others notice nothing.
bool Intake::is_within_quota(std::uint64_t source) {
  const std::uint64_t participant = senders_.participant_of(requests_.handle(), source);
  if (quota_.take(participant, monotonic_ns()) == ParticipantQuota::Result::kAllowed) return true;
  ports_.commands_dropped.fetch_add(1, std::memory_order_relaxed);
  return false;
}

bool Intake::may_go_on(const dds::SessionRequest& request) {
  const bool is_open = request.request == dds::SessionRequestKind::kOpen;
  if (last_ == nullptr || !is_open || check_.is_held()) return true;
  std::string refusal = telemetry::refusal_to_go_on(last_->get(), request, setup_);
  if (refusal.empty()) return true;
  publish(check_.refuse_program(request, std::move(refusal)));
  return false;
}

void Intake::begin_session(const dds::SessionRequest& request) {
  ports_.session_settings.store({request.session, settings_of(request)});
  opened_ = check_.message();
  remark_ = last_ == nullptr ? "" : telemetry::remark_on(last_->get(), request, setup_);
  const std::lock_guard lock(view_mutex_);
  line_ends_.clear();
}

bool Intake::is_line_end(std::uint64_t session, std::uint64_t block) {
  const std::lock_guard lock(view_mutex_);
  return session == view_.session && line_ends_.is_line_end(block);
}

void Intake::take_batches() {
  dds::Batch batch;
  stream::Accepted accepted;
  for (int left = kMaxSamples; left > 0 && batches_.take(batch); --left) {
    const std::int64_t begun_ns = spans_.is_on() ? monotonic_ns() : 0;
    std::optional<dds::Credit> answer = check_.on_batch(batch, context(), accepted);
    if (!push(accepted)) answer = check_.on_queue_full(context());
    publish(answer);
    if (spans_.is_on()) spans_.write(trace::Doing::kTakeBlocks, begun_ns, monotonic_ns(), pushed_);
  }
}

/// There is room: when credit was granted, so many places were free and kReserve more, only this
/// thread fills places, and size() never counts too few that are filled. Were it broken, the
/// session ends, with a message, at the block before the first that was lost.
bool Intake::push(const stream::Accepted& accepted) {
  if (accepted.count == 0) return true;
  std::size_t count = 0;
  while (count < accepted.count &&
         ports_.blocks.stage({check_.session(), accepted.blocks[count]})) {
    ++count;
  }
  pushed_ += count;
  note_line_ends(accepted, count);
  ports_.blocks.publish();
  ports_.planner_wake.notify();
  return count == accepted.count;
}

void Intake::note_line_ends(const stream::Accepted& accepted, std::size_t count) {
  const std::lock_guard lock(view_mutex_);
  for (std::size_t i = 0; i < count; ++i) {
    const ClBlock& block = accepted.blocks[i];
    if (block.kind == BlockKind::kEnd) {
      line_ends_.end();
    } else {
      line_ends_.add(block.sequence, block.line);
    }
  }
}

void Intake::show_cut_off() noexcept {
  if (!check_.is_cut_off() || cut_off_session_ == check_.session()) return;
  QueuedBlock none;
  none.session = check_.session();
  none.is_cut_off = true;
  if (!ports_.blocks.stage(none)) return;  // again as soon as there is room
  cut_off_session_ = check_.session();
  ++pushed_;
  ports_.blocks.publish();
  ports_.planner_wake.notify();
}

void Intake::look_for_station() {
  const std::int64_t now_ns = monotonic_ns();
  if (!is_station_there_ || !check_.is_held() || now_ns - looked_ns_ < kLookForStation_ns) return;
  looked_ns_ = now_ns;
  if (requests_.has_source(station_source_)) return;
  is_station_there_ = false;
  check_.on_station_lost(check_.session());
}

void Intake::publish(const std::optional<dds::Credit>& credit) {
  if (!credit) return;
  (void)credits_.write(*credit);
  if (credit->session == check_.session() && credit->verdict >= dds::Verdict::kRefusedStation) {
    refused_session_ = credit->session;
  }
}

void Intake::show() {
  ports_.session.store(check_.session(), std::memory_order_relaxed);
  if (!check_.is_held()) ports_.set_up.claim.give_back(ProgramClaim::Holder::kSession);
  const stream::IntakeCounters& counters = check_.counters();
  const std::lock_guard lock(view_mutex_);
  view_.session = check_.session();
  if (check_.is_held()) {
    view_.station = check_.request().station;
    view_.program = check_.request().program;
    view_.options = check_.request().options;
    view_.identity = station_identity_;
    view_.file_checksum = check_.request().file_checksum;
    view_.from_line = check_.request().from_line;
    view_.is_move = (check_.request().policies & dds::kPolicyMove) != 0;
    view_.block_count = check_.request().block_count;
    view_.blocks_received = check_.next_sequence();
  }
  view_.batches_dropped = counters.batches_duplicate + counters.batches_stale;
  view_.batches_lost = counters.batches_corrupted + counters.batches_gap;
  view_.message = check_.message();
  if (!remark_.empty() && view_.message == opened_) view_.message += "; " + remark_;
}

SessionView Intake::view() const {
  const std::lock_guard lock(view_mutex_);
  return view_;
}

}  // namespace meridian::interpolator
