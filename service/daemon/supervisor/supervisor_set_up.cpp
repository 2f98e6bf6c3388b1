// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "meridian/cycle/state_table.hpp"
#include "service/daemon/supervisor/supervisor.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/protocol/frame_sum.hpp"
#include "service/protocol/limits_sum.hpp"
#include "service/protocol/tools_sum.hpp"
#include "service/recording/telemetry/journal/set_up_text.hpp"
#include "service/recording/telemetry/reply_words.hpp"
#include "service/recording/telemetry/words.hpp"

/// The set-up: a change of work frames, tools or soft limits is written to disk, then passed to the
/// cycle, which may still refuse it, then to everybody, and answered last. One at a time, and none
/// beside a program.
namespace meridian::interpolator {

SetUpInForce in_force_by(const telemetry::SetUp& set_up, const MachineModel& machine,
                         const ToolTable& tools, std::uint32_t change) {
  const WorkFrames& frames = set_up.frames;
  const WorkFrame* const row = frames.find(frames.active());
  const RigidTransform X_MW = row != nullptr ? config::frame_of(*row) : machine.X_MW;
  SetUpInForce out;
  out.change = change;
  out.number = static_cast<std::uint8_t>(frames.active());
  out.rotation = stream::rows_of(X_MW.rotation);
  out.origin_mm = to_array(X_MW.origin_mm);
  out.sum = stream::frame_sum(out.rotation, out.origin_mm, frames.rows());
  out.tools = stream::tools_sum(tools);
  out.soft_limits = set_up.limits;
  out.travel = travel_under(set_up.limits, machine);
  out.limits = stream::limits_sum(set_up.limits);
  return out;
}

void Supervisor::keep_set_up(telemetry::SetUpFile& file, const telemetry::SetUp& set_up,
                             const ToolTable& tools, const SetUpInForce& in_force) {
  set_up_file_ = &file;
  set_up_ = next_set_up_ = set_up;
  tools_ = tools;
  in_force_ = in_force;
  ports_.set_up.reported.store(in_force.change, std::memory_order_relaxed);
}

FrameOrder Supervisor::read_frame_order(std::uint64_t key) noexcept {
  FrameOrder nothing;
  nothing.word = static_cast<FrameWord>(0xFF);
  for (const FrameArrival* at = ports_.set_up.orders.peek(0); at != nullptr && at->key <= key;
       at = ports_.set_up.orders.peek(0)) {
    const FrameArrival arrival = *at;
    ports_.set_up.orders.drop(1);
    if (arrival.key == key) return arrival.order;
  }
  return nothing;
}

std::optional<std::string> Supervisor::read_tool_file(std::uint64_t key, std::uint64_t& seen) {
  auto& files = ports_.set_up.tool_files;
  std::optional<std::string> text;
  for (const ToolArrival* at = files.peek(0); at != nullptr && at->key <= key && !text;
       at = files.peek(0)) {
    if (at->key == key) {
      text = at->file.data();
      seen = at->tools_seen;
    }
    files.drop(1);
  }
  return text;
}

bool Supervisor::is_set_up_stale(const dds::CommandRequest& request) const noexcept {
  return request.status_seen < set_up_status_ &&
         (is_set_up(request.verb) || leads_to_motion(request.verb));
}

void Supervisor::begin_set_up_change(const Pending& command) {
  const State state = view_.record.state;
  const Verb verb = command.request.verb;
  const auto refuse = [&](Refusal why) {
    reply(command, false, why, telemetry::describe(verb, why, state, 0, model_));
  };
  const VerbEffect effect = effect_of(state, verb);
  if (set_up_phase_ != SetUpPhase::kNone) {
    return reply(command, false, Refusal::kStale,
                 std::string(name_of(verb)) +
                     " refused: the set-up is being changed just now; look again, then repeat");
  }
  if (effect.effect == Effect::kRefused) return refuse(effect.refusal);
  if (set_up_file_ == nullptr || !set_up_file_->is_kept()) return refuse(Refusal::kNotJournalled);
  next_set_up_ = set_up_;
  next_tools_ = tools_;
  const bool is_understood = verb == Verb::kFrame  ? change_frames(command)
                             : verb == Verb::kTool ? change_tools(command)
                                                   : change_limits(command);
  if (!is_understood) return;
  if (!ports_.set_up.claim.try_take(ProgramClaim::Holder::kSetUp)) {
    return refuse(Refusal::kProgramPresent);
  }
  set_up_command_ = command;
  set_up_file_->ask(next_set_up_);
  set_up_phase_ = SetUpPhase::kSaving;
}

bool Supervisor::change_frames(const Pending& command) {
  const FrameOrder& order = command.request.frame;
  const FrameFault fault = next_set_up_.frames.apply(order);
  if (fault == FrameFault::kNone) return true;
  reply(command, false, Refusal::kOutOfRange,
        "frame refused: " + telemetry::describe(fault, order.frame.number));
  return false;
}

bool Supervisor::change_tools(const Pending& command) {
  const auto refuse = [&](Refusal why, const std::string& text) {
    reply(command, false, why, "tool refused: " + text);
    return false;
  };
  if (!tool_file_) return refuse(Refusal::kWrongState, "too many at once; say it again");
  const std::uint64_t seen = command.request.tools_seen;
  if (seen != 0 && seen != in_force_.tools) {
    return refuse(Refusal::kStale, "the tool table is another one by now; look again, then repeat");
  }
  if (ports_.is_tool_changing.load(std::memory_order_relaxed)) {
    return refuse(
        Refusal::kWrongState,
        "which tool is in the spindle is not known, its change is not answered yet; wait");
  }
  if (tool_file_->empty()) {
    next_set_up_.tools.reset();
    next_tools_ = own_tools_;
    return true;
  }
  try {
    next_tools_ = config::parse_tools(*tool_file_, "tools");
  } catch (const config::ConfigError& error) {
    return refuse(Refusal::kOutOfRange, error.what());
  }
  next_set_up_.tools = *tool_file_;
  return true;
}

void Supervisor::work_on_set_up_change() {
  using Progress = telemetry::SetUpFile::Progress;
  switch (set_up_phase_) {
    case SetUpPhase::kSaving: {
      const Progress progress = set_up_file_->look();
      if (progress == Progress::kWritten) ask_cycle_for_set_up();
      if (progress != Progress::kFailed) return;
      set_up_refusal_ = Refusal::kNotJournalled;
      set_up_text_ =
          std::string(name_of(set_up_command_.request.verb)) +
          " refused: the set-up cannot be written: " + std::strerror(set_up_file_->error());
      return end_set_up_change();
    }
    case SetUpPhase::kReverting:
      if (set_up_file_->look() != Progress::kAsked) end_set_up_change();
      return;
    case SetUpPhase::kAccepted:
      return pass_set_up_on();
    case SetUpPhase::kReported: {
      const bool is_in_status =
          ports_.set_up.reported.load(std::memory_order_acquire) == in_force_.change;
      if (!is_in_status || has_set_up_to_report()) return;
      set_up_status_ = ports_.set_up.status.load(std::memory_order_relaxed);
      return end_set_up_change();
    }
    case SetUpPhase::kNone:
    case SetUpPhase::kAtTheCycle:
      return;
  }
}

void Supervisor::ask_cycle_for_set_up() {
  ports_.set_up.for_cycle.store(
      in_force_by(next_set_up_, model_, next_tools_, in_force_.change + 1));
  set_up_command_.key = ports_.commands.next_request();  // the cycle has had others meanwhile
  const Verb verb = set_up_command_.request.verb;
  Pending* const slot = find_slot(verb);
  const double argument = verb == Verb::kFrame ? next_set_up_.frames.active() : 0;
  const bool is_sent =
      slot != nullptr &&
      ports_.commands.stage({.request = set_up_command_.key, .verb = verb, .argument = argument});
  if (!is_sent) {
    return take_set_up_back(Refusal::kWrongState,
                            std::string(name_of(verb)) + " refused: too many commands");
  }
  *slot = set_up_command_;
  ports_.commands.publish();
  set_up_phase_ = SetUpPhase::kAtTheCycle;
}

/// What the cycle refuses stands on disk by then, and was acknowledged to nobody.
void Supervisor::take_set_up_back(Refusal refusal, const std::string& text) {
  set_up_refusal_ = refusal;
  set_up_text_ = text;
  set_up_file_->ask(set_up_);
  set_up_phase_ = SetUpPhase::kReverting;
}

void Supervisor::answer_set_up(bool is_accepted, Refusal refusal) {
  if (set_up_phase_ != SetUpPhase::kAtTheCycle) return;
  const Verb verb = set_up_command_.request.verb;
  if (!is_accepted) {
    return take_set_up_back(refusal,
                            telemetry::describe(verb, refusal, view_.record.state, 0, model_));
  }
  set_up_ = next_set_up_;
  tools_ = next_tools_;
  in_force_ = in_force_by(set_up_, model_, tools_, in_force_.change + 1);
  put_in_spindle(measured(in_spindle()));
  tool_before_ = measured(tool_before_);
  set_up_refusal_ = Refusal::kNone;
  set_up_text_ = verb == Verb::kFrame  ? words_of_frames()
                 : verb == Verb::kTool ? words_of_tools()
                                       : words_of_limits();
  set_up_phase_ = SetUpPhase::kAccepted;
  pass_set_up_on();
}

/// Once more where a reader is at its mailbox at this very moment.
void Supervisor::pass_set_up_on() {
  for (Mailbox<ToolTable>* box : {&ports_.set_up.telemetry_tools, &ports_.set_up.intake_tools,
                                  &ports_.set_up.planner_tools}) {
    ToolTable tools = tools_;
    if (!box->try_put(tools)) return;
  }
  ports_.set_up.for_planner.store(in_force_);
  ports_.set_up.for_intake.store(in_force_);
  ports_.set_up.for_telemetry.store(in_force_);
  has_set_up_to_report_.store(true, std::memory_order_release);
  set_up_phase_ = SetUpPhase::kReported;
}

std::string Supervisor::words_of_frames() const {
  const WorkFrames& frames = set_up_.frames;
  const WorkFrame* const row = frames.find(frames.active());
  const FrameOrder& order = set_up_command_.request.frame;
  const std::string number = std::to_string(order.frame.number);
  const std::string done = order.word == FrameWord::kSet     ? "frame " + number + " set; "
                           : order.word == FrameWord::kClear ? "frame " + number + " cleared; "
                                                             : "";
  return done + "work frame " +
         telemetry::frame_name(frames.active(), row != nullptr ? row->name.data() : "") +
         " in force";
}

std::string Supervisor::words_of_tools() const {
  const std::string table = set_up_.tools ? "tool table of the set-up" : "the service's tool table";
  return table + " in force, tools: " + std::to_string(tools_.tools().size()) + "; " +
         telemetry::tool_name(in_spindle().number, in_spindle().length_mm) + " in the spindle";
}

Supervisor::SpindleTool Supervisor::in_spindle() const noexcept {
  return {ports_.spindle_tool.load(std::memory_order_relaxed),
          ports_.spindle_tool_mm.load(std::memory_order_relaxed)};
}

void Supervisor::put_in_spindle(const SpindleTool& tool) noexcept {
  ports_.spindle_tool.store(tool.number, std::memory_order_relaxed);
  ports_.spindle_tool_mm.store(tool.length_mm, std::memory_order_relaxed);
}

/// A tool that the table has no longer stays as long as it was.
Supervisor::SpindleTool Supervisor::measured(SpindleTool tool) const noexcept {
  const Tool* const row = tool.number != 0 ? tools_.find(static_cast<int>(tool.number)) : nullptr;
  if (row != nullptr) tool.length_mm = row->tip_length_mm();
  return tool;
}

void Supervisor::end_set_up_change() {
  set_up_phase_ = SetUpPhase::kNone;
  ports_.set_up.claim.give_back(ProgramClaim::Holder::kSetUp);
  reply(set_up_command_, set_up_refusal_ == Refusal::kNone, set_up_refusal_, set_up_text_);
}

}  // namespace meridian::interpolator
