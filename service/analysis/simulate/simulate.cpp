// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/simulate.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include "meridian/cycle/joint_masks.hpp"
#include "meridian/cycle/state_table.hpp"
#include "meridian/cycle/step.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/planner/time_law.hpp"
#include "service/analysis/certify/plan_tap.hpp"
#include "service/analysis/simulate/block_feed.hpp"
#include "service/analysis/simulate/limit_meter.hpp"
#include "service/analysis/simulate/rest_meter.hpp"

namespace meridian::simulate {
namespace {

constexpr std::uint64_t kEnableCycle = 10;  ///< Off before it
constexpr std::uint64_t kRestCycles = 10;   ///< at rest after the end

/// One run: the world around step(), and the books.
class Run {
 public:
  Run(cl::ClReader& reader, const MachineModel& model, const ToolTable& tools,
      const SimulateOptions& options)
      : model_(model),
        options_(options),
        port_(std::make_unique<MotionPort>()),
        motion_(*port_),
        tap_(*port_),
        feed_(reader, model, tools, *port_, options.has_action_peer, options.explainer),
        meter_(model),
        state_({.stops_at_optional = options.stops_at_optional}, rate_bounds(model)) {
    for (int i = 0; i < model.joint_count; ++i) drives_[i] = drive_spec(model, i).home;
    if (options.start) drives_ = *options.start;
    in_.session = 1;
    in_.tool_length_mm = model_.tool_length_mm;
    if (!options.events.feed_marks.empty()) feed_.replay_feed(options.events.feed_marks);
  }

  void go(SimulateReport& report, const std::function<void(const CycleRecord&)>& take) {
    while (!is_over(report)) {
      if (feed_.has_begun()) feed_.fill();
      certify();
      prepare();
      step(model_, state_, motion_, in_, out_);
      tap_.note_dropped();
      drives_ = out_.record.setpoint.position;
      take(out_.record);
      keep_books(report);
      if (state_.state == State::kReady && !feed_.has_begun()) {
        feed_.begin(out_.record.joints, state_.epoch, options_.settings);
      }
    }
    if (options_.explainer != nullptr) options_.explainer->finish();
    if (options_.certifier != nullptr) options_.certifier->finish();
    report.cycles = in_.cycle;
    report.motion_blocks = feed_.motion_blocks();
    report.feeds_limited = feed_.feeds_limited();
    report.relaxed_axes = feed_.relaxed_axes().first;
    report.relaxed_count = feed_.relaxed_axes().count;
    report.largest_deviation_rad = feed_.relaxed_axes().largest_rad;
    report.rewinds = feed_.rewinds();
    report.rewind_count = feed_.rewind_count();
    if (report.outcome == Outcome::kDone || report.outcome == Outcome::kStarved) {
      if (!feed_.refusal().empty()) report.outcome = Outcome::kRefused;
    }
    if (report.outcome == Outcome::kRefused) report.reason = feed_.refusal();
  }

 private:
  void certify() {
    if (options_.certifier == nullptr) return;
    tap_.look([this](const TimePiece& piece, const PathPiece* path) {
      options_.certifier->add(piece, path);
    });
  }

  /// What the cycle is to see next.
  void prepare() {
    const bool is_start =
        state_.state == State::kLoaded && !start_cycle_ && !is_verb_due_before_start();
    in_.lost_periods = take_loss(is_start ? in_.cycle + 1 : start_cycle_.value_or(in_.cycle + 2));
    in_.cycle += 1 + in_.lost_periods;
    in_.due_ns = static_cast<std::int64_t>(in_.cycle) * model_.cycle_ns;
    in_.now_ns = in_.due_ns;
    const std::uint32_t all = all_joints(model_);
    const bool is_on = is_enabled(state_.state);
    in_.feedback = {.arrival_ns = in_.now_ns,
                    .cycle_seen = in_.cycle - 1 - in_.lost_periods,
                    .position = drives_,
                    .joint_mask = all,
                    .enabled_mask = is_on ? all : 0,
                    .fault_mask = 0,
                    .referenced_mask = all,
                    .emergency_stop = false};
    answer_action();
    in_.has_command = true;
    if (in_.cycle == kEnableCycle) {
      command(Verb::kEnable);
    } else if (is_verb_due_before_start()) {
      const OperatorEvent& verb = options_.events.verbs[next_verb_++];
      command(verb.verb, verb.argument);
    } else if (is_start) {
      start_cycle_ = in_.cycle;
      command(Verb::kStart);
    } else if (is_event_due()) {
      const OperatorEvent& event = options_.events.verbs[next_verb_++];
      command(event.verb, event.argument);
    } else if (is_at_program_stop() && !has_resume_left()) {
      command(Verb::kResume);
    } else {
      in_.has_command = false;
    }
  }

  void command(Verb verb, double argument = 0) { in_.command = {++request_, verb, argument}; }

  /// Periods that are lost in front of the next cycle. Drives go on without them as they do live.
  [[nodiscard]] std::uint32_t take_loss(std::uint64_t start_cycle) {
    const auto& losses = options_.events.losses;
    if (next_loss_ == losses.size() || start_cycle > in_.cycle + 1) return 0;
    const LostPeriods& loss = losses[next_loss_];
    const auto count = static_cast<std::uint32_t>(loss.count);
    if (static_cast<std::int64_t>(in_.cycle + 1 + count - start_cycle) < loss.cycle) return 0;
    ++next_loss_;
    model_.bridge_cycles = loss.is_bridged ? std::max(loss.count, bridge_cycles_)
                                           : std::min(loss.count - 1, bridge_cycles_);
    const Setpoint& sent = out_.record.setpoint;
    if (!loss.is_bridged || (sent.flags & kSetpointEnabled) == 0) return count;
    const double time = 1e-9 * static_cast<double>(model_.cycle_ns) * count;
    for (std::size_t i = 0; i < drives_.size(); ++i) drives_[i] += sent.velocity[i] * time;
    return count;
  }

  void answer_action() {
    const auto& answers = options_.events.answers;
    in_.action = {.sequence = state_.sequence,
                  .is_answered = state_.action == ActionState::kWaiting,
                  .is_done = true};
    if (!in_.action.is_answered || next_answer_ == answers.size()) return;
    in_.action.is_done = answers[next_answer_].is_done;
    in_.action.is_answered = is_reached(answers[next_answer_].cycle);
    if (in_.action.is_answered) ++next_answer_;
  }

  /// `cycle` counts from that of the start.
  [[nodiscard]] bool is_reached(std::int64_t cycle) const {
    return start_cycle_ && static_cast<std::int64_t>(in_.cycle - *start_cycle_) >= cycle;
  }

  [[nodiscard]] bool is_event_due() const {
    return next_verb_ < options_.events.verbs.size() &&
           is_reached(options_.events.verbs[next_verb_].cycle);
  }

  /// A run that is replayed goes on from its program stops when its operator did.
  [[nodiscard]] bool has_resume_left() const {
    const auto& verbs = options_.events.verbs;
    return std::any_of(verbs.begin() + static_cast<std::ptrdiff_t>(next_verb_), verbs.end(),
                       [](const OperatorEvent& event) { return event.verb == Verb::kResume; });
  }

  [[nodiscard]] bool is_verb_due_before_start() const {
    return state_.state == State::kLoaded && next_verb_ < options_.events.verbs.size() &&
           options_.events.verbs[next_verb_].cycle < 0;
  }

  [[nodiscard]] bool is_at_program_stop() const {
    if (state_.state != State::kHeld || motion_.piece() == nullptr) return false;
    const TimeKind kind = motion_.piece()->kind;
    return kind == TimeKind::kStop || kind == TimeKind::kOptionalStop;
  }

  void keep_books(SimulateReport& report) {
    for (std::size_t i = 0; i < out_.event_count; ++i) keep_event(out_.events[i], report);
    const double period = report.cycle_s;
    const bool is_moving = (out_.record.setpoint.flags & kSetpointMoving) != 0;
    if (is_program_over_ || !start_cycle_ || in_.cycle <= *start_cycle_) return;
    const bool is_approach = !has_approached_ && out_.record.motion == MotionKind::kApproach;
    has_approached_ = has_approached_ || (!is_approach && is_moving);
    if (is_approach) {
      report.approach_s += period;
    } else {
      report.program_s += period;
      if (!is_moving) report.waiting_s += period;
    }
    const PathPiece* path = motion_.path();
    const double length = path != nullptr ? path->tool_length_mm : model_.tool_length_mm;
    const TimePiece* piece = motion_.piece();
    const double feed = piece != nullptr ? piece->feed_factor * piece->feed_mm_per_s : 0;
    meter_.add(out_.record, length, feed, report.shares);
    if (is_exact_stop()) count_rests(report);
    if (options_.explainer != nullptr && !is_approach) {
      options_.explainer->add_cycle(out_.record, piece, path, state_.piece_time, length);
    }
  }

  [[nodiscard]] bool is_exact_stop() const {
    return options_.settings.transition.value_or(model_.transition) == Transition::kExactStop;
  }

  /// In plan time: what the operator holds or slows is no cost of exact stop.
  void count_rests(SimulateReport& report) {
    const TimePiece* piece = motion_.piece();
    const PathPiece* path = motion_.path();
    const bool is_cut = piece != nullptr && piece->kind == TimeKind::kMove && path != nullptr &&
                        path->motion == MotionKind::kCut;
    if (!is_cut || (piece->is_from_rest && piece->window != window_)) rests_.rest();
    if (piece != nullptr) window_ = piece->window;
    if (is_cut) {
      const double speed = state_at(*piece, std::min(state_.piece_time, piece->duration)).ds;
      rests_.move(speed, out_.record.rate * report.cycle_s);
    }
    report.vertex_stops_s = rests_.lost_s();
  }

  void keep_event(const Event& event, SimulateReport& report) {
    switch (event.code) {
      case EventCode::kProgramEnd:
        is_program_over_ = true;
        return;
      case EventCode::kBlockDone:
        ++report.blocks_done;
        return;
      case EventCode::kAlarm:
        if (report.reason.empty()) {
          report.reason = "alarm " + std::to_string(event.a) + " of joint " +
                          std::to_string(event.b) + " at line " + std::to_string(event.line);
        }
        break;
      case EventCode::kStateChanged:
      case EventCode::kRefused:
        break;
      default:
        return;
    }
    if (report.happenings.size() < SimulateReport::kMaxHappenings) {
      report.happenings.push_back({in_.cycle, event});
    } else {
      ++report.happenings_dropped;
    }
  }

  /// Whether nothing more will happen; sets the outcome.
  [[nodiscard]] bool is_over(SimulateReport& report) {
    if (in_.cycle <= kEnableCycle) return false;
    const bool has_events = start_cycle_ && next_verb_ < options_.events.verbs.size();
    bool is_end = false;
    switch (state_.state) {
      case State::kFault:
        report.outcome = Outcome::kFault;
        return ++rested_ > kRestCycles;
      case State::kReady:
        is_end = is_program_over_ || start_cycle_ || feed_.is_over();
        report.outcome = is_program_over_ ? Outcome::kDone
                         : start_cycle_   ? Outcome::kStopped
                                          : Outcome::kStarved;
        break;
      case State::kDisabling:  // a live run that was switched off as soon as it was through
      case State::kOff:
      case State::kLoaded:  // the start was refused
        is_end = start_cycle_ && !has_events;
        report.outcome = is_program_over_ ? Outcome::kDone : Outcome::kStopped;
        break;
      case State::kStarved:
        is_end = feed_.is_over();
        report.outcome = Outcome::kStarved;
        break;
      case State::kStepping:  // who steps is who sends it on
        is_end = !has_events;
        report.outcome = Outcome::kStopped;
        break;
      case State::kHeld:
        is_end = !has_events && !is_at_program_stop();
        report.outcome = Outcome::kStopped;
        break;
      case State::kApproaching:
      case State::kRunning:
        is_end = !has_events && out_.record.rate == 0 && state_.feed_override == 0;
        report.outcome = Outcome::kStopped;
        break;
      default:
        break;
    }
    rested_ = is_end ? rested_ + 1 : 0;
    return rested_ > kRestCycles;
  }

  MachineModel model_;  ///< drives bridge what those of the live run bridged
  const int bridge_cycles_ = model_.bridge_cycles;
  const SimulateOptions& options_;
  std::unique_ptr<MotionPort> port_;
  MotionReader motion_;
  certify::PlanTap tap_;
  BlockFeed feed_;
  LimitMeter meter_;
  RestMeter rests_;
  std::uint32_t window_ = 0;  ///< that the cycle was in
  CycleState state_;
  CycleInputs in_;
  StepOutput out_;
  JointVector drives_{};  ///< where they are
  std::optional<std::uint64_t> start_cycle_;
  std::size_t next_verb_ = 0, next_loss_ = 0, next_answer_ = 0;
  std::uint64_t request_ = 0, rested_ = 0;
  bool is_program_over_ = false, has_approached_ = false;
};

}  // namespace

SimulateReport simulate(cl::ClReader& reader, const std::string& name, const MachineModel& model,
                        const ToolTable& tools, const SimulateOptions& options,
                        const std::function<void(const CycleRecord&)>& take) {
  const auto begin = std::chrono::steady_clock::now();
  SimulateReport report;
  report.name = name;
  report.cycle_s = static_cast<double>(model.cycle_ns) * 1e-9;
  Run(reader, model, tools, options).go(report, take);
  const cl::ClSummary& summary = reader.summary();
  report.blocks = summary.blocks;
  report.at_feed_s = summary.cut_time_s;
  report.cut_length_mm = summary.cut_length_mm;
  report.rapid_length_mm = summary.rapid_length_mm;
  report.computing_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

}  // namespace meridian::simulate
