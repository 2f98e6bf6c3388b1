// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "meridian/rt/state_table.hpp"
#include "service/config/machine_file.hpp"
#include "service/interpolator/supervisor.hpp"
#include "service/stream/frame_sum.hpp"
#include "service/telemetry/reply_words.hpp"
#include "service/telemetry/set_up_text.hpp"
#include "service/telemetry/words.hpp"
#include "service/text/checksum.hpp"

/// Work frames: a word about the set-up is written to disk, then told to the cycle, which may still
/// refuse it, then to everybody, and answered last. One at a time, and none beside a program.
namespace meridian::interpolator {

FrameInForce frame_in_force(const WorkFrames& frames, const MachineModel& machine,
                            std::uint32_t change) {
  const WorkFrame* const row = frames.find(frames.active());
  const config::Frame frame = row != nullptr
                                  ? config::frame_of(*row)
                                  : config::Frame{machine.frame_rotation, machine.frame_origin_mm};
  FrameInForce out;
  out.change = change;
  out.number = static_cast<std::uint8_t>(frames.active());
  out.rotation = stream::rows_of(frame.rotation);
  out.origin_mm = to_array(frame.origin_mm);
  out.sum = stream::frame_sum(out.rotation, out.origin_mm);
  return out;
}

void Supervisor::keep_frames(telemetry::SetUpFile& file, const WorkFrames& frames,
                             const FrameInForce& in_force) {
  set_up_ = &file;
  frames_ = next_frames_ = frames;
  frames_in_force_ = in_force;
  frame_change_ = in_force.change;
  ports_.frame.told.store(in_force.change, std::memory_order_relaxed);
}

FrameOrder Supervisor::read_frame_order(std::uint64_t key) noexcept {
  FrameOrder nothing;
  nothing.word = static_cast<FrameWord>(0xFF);
  for (const FrameArrival* at = ports_.frame.orders.peek(0); at != nullptr && at->key <= key;
       at = ports_.frame.orders.peek(0)) {
    const FrameArrival arrival = *at;
    ports_.frame.orders.drop(1);
    if (arrival.key == key) return arrival.order;
  }
  return nothing;
}

bool Supervisor::is_frame_stale(const dds::CommandRequest& request) const noexcept {
  return request.status_seen < frame_status_ &&
         (request.verb == Verb::kFrame || leads_to_motion(request.verb));
}

void Supervisor::begin_frame_change(const Pending& command) {
  const auto refuse = [&](Refusal why, const std::string& text) {
    reply(command, false, why, "frame refused: " + text);
  };
  const State state = view_.record.state;
  const VerbEffect effect = effect_of(state, Verb::kFrame);
  if (frame_phase_ != FramePhase::kNone) {
    return refuse(Refusal::kStale, "another one is being set just now; look again, then repeat");
  }
  if (effect.effect == Effect::kRefused) {
    return reply(command, false, effect.refusal,
                 telemetry::describe(Verb::kFrame, effect.refusal, state, 0, model_));
  }
  if (set_up_ == nullptr || !set_up_->is_kept()) {
    return reply(command, false, Refusal::kNotJournalled,
                 telemetry::describe(Verb::kFrame, Refusal::kNotJournalled, state, 0, model_));
  }
  next_frames_ = frames_;
  const FrameOrder& order = command.request.frame;
  if (const FrameFault fault = next_frames_.apply(order); fault != FrameFault::kNone) {
    return refuse(Refusal::kOutOfRange, telemetry::describe(fault, order.frame.number));
  }
  if (!ports_.frame.claim.try_take(ProgramClaim::Holder::kSetUp)) {
    return reply(command, false, Refusal::kProgramPresent,
                 telemetry::describe(Verb::kFrame, Refusal::kProgramPresent, state, 0, model_));
  }
  frame_command_ = command;
  set_up_->ask(next_frames_);
  frame_phase_ = FramePhase::kOnItsWayToDisk;
}

void Supervisor::work_on_frame_change() {
  using Progress = telemetry::SetUpFile::Progress;
  switch (frame_phase_) {
    case FramePhase::kOnItsWayToDisk: {
      const Progress progress = set_up_->look();
      if (progress == Progress::kWritten) ask_cycle_for_frame();
      if (progress != Progress::kFailed) return;
      frame_refusal_ = Refusal::kNotJournalled;
      frame_text_ = std::string("frame refused: the set-up cannot be written: ") +
                    std::strerror(set_up_->error());
      return end_frame_change();
    }
    case FramePhase::kOnItsWayBack:
      if (set_up_->look() != Progress::kAsked) end_frame_change();
      return;
    case FramePhase::kTold: {
      const bool is_in_status = ports_.frame.told.load(std::memory_order_acquire) == frame_change_;
      if (!is_in_status || has_frames_to_tell()) return;
      frame_status_ = ports_.frame.status.load(std::memory_order_relaxed);
      return end_frame_change();
    }
    case FramePhase::kNone:
    case FramePhase::kAtTheCycle:
      return;
  }
}

void Supervisor::ask_cycle_for_frame() {
  ports_.frame.for_cycle.store(frame_in_force(next_frames_, model_, frame_change_ + 1));
  frame_command_.key = ports_.commands.next_request();  // the cycle has had others meanwhile
  Pending* const place = find_place(Verb::kFrame);
  const bool is_sent =
      place != nullptr && ports_.commands.stage({.request = frame_command_.key,
                                                 .verb = Verb::kFrame,
                                                 .argument = double(next_frames_.active())});
  if (!is_sent) return take_frame_back(Refusal::kWrongState, "frame refused: too many commands");
  *place = frame_command_;
  ports_.commands.publish();
  frame_phase_ = FramePhase::kAtTheCycle;
}

/// What the cycle refuses stands on disk by then, and was acknowledged to nobody.
void Supervisor::take_frame_back(Refusal refusal, const std::string& text) {
  frame_refusal_ = refusal;
  frame_text_ = text;
  set_up_->ask(frames_);
  frame_phase_ = FramePhase::kOnItsWayBack;
}

void Supervisor::answer_frame(bool is_accepted, Refusal refusal) {
  if (frame_phase_ != FramePhase::kAtTheCycle) return;
  if (!is_accepted) {
    return take_frame_back(
        refusal, telemetry::describe(Verb::kFrame, refusal, view_.record.state, 0, model_));
  }
  frames_ = next_frames_;
  const FrameInForce in_force = frame_in_force(frames_, model_, ++frame_change_);
  ports_.frame.for_planner.store(in_force);
  ports_.frame.for_intake.store(in_force);
  ports_.frame.for_telemetry.store(in_force);
  frames_in_force_ = in_force;
  has_frames_to_tell_.store(true, std::memory_order_release);
  const WorkFrame* const row = frames_.find(frames_.active());
  const FrameOrder& order = frame_command_.request.frame;
  const std::string number = std::to_string(order.frame.number);
  frame_refusal_ = Refusal::kNone;
  frame_text_ = order.word == FrameWord::kSet     ? "frame " + number + " set; "
                : order.word == FrameWord::kClear ? "frame " + number + " cleared; "
                                                  : "";
  frame_text_ += "work frame " +
                 telemetry::frame_name(frames_.active(), row != nullptr ? row->name.data() : "") +
                 " in force";
  frame_phase_ = FramePhase::kTold;
}

void Supervisor::end_frame_change() {
  frame_phase_ = FramePhase::kNone;
  ports_.frame.claim.give_back(ProgramClaim::Holder::kSetUp);
  reply(frame_command_, frame_refusal_ == Refusal::kNone, frame_refusal_, frame_text_);
}

}  // namespace meridian::interpolator
