// SPDX-License-Identifier: Apache-2.0
#include "meridian/interpolator.hpp"

#include <atomic>
#include <deque>
#include <utility>

#include "meridian/cycle/joint_masks.hpp"
#include "meridian/cycle/spsc_ring.hpp"
#include "meridian/cycle/state_table.hpp"
#include "meridian/cycle/step.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/planner/smooth_planner.hpp"
#include "service/protocol/block_check.hpp"

namespace meridian {
namespace {

using Result = Expected<void, std::string>;

constexpr std::uint64_t kEnableCycle = 10;  ///< as in a simulated run: cycle numbers agree
constexpr std::uint64_t kMaxEnableCycles = 100;

[[nodiscard]] JointVector home_of(const MachineModel& model) noexcept {
  JointVector drives{};
  for (int i = 0; i < model.joint_count; ++i) drives[i] = drive_spec(model, i).home;
  return drives;
}

[[nodiscard]] Result refused(std::string reason) {
  return tl::unexpected<std::string>(std::move(reason));
}

}  // namespace

/// The pushing thread owns what checks and plans, update() what steps; between them are the motion
/// port, the requests, and the position of rest.
class Interpolator::Machine {
 public:
  Machine(const MachineModel& model, const ToolTable& tools, const JointVector& drives)
      : model_(model),
        tools_(tools),
        check_(model_, stream::lengths_of(tools)),
        planner_(model_, tools_),
        writer_(port_),
        reader_(port_),
        state_({}, rate_bounds(model)) {
    in_.session = 1;
    in_.tool_length_mm = model_.tool_length_mm;
    get_ready(drives);
    begin_planning();
    if (state_.state != State::kReady)
      refusal_ = "the drives' position is no position to start from";
  }

  [[nodiscard]] Result push(const ClBlock& block) {
    if (!refusal_.empty()) return refused(refusal_);
    if (is_at_rest_.load(std::memory_order_acquire) || has_end_) {
      return refused("the program is over; call begin() for the next one");
    }
    ClBlock checked = block;
    const BlockReject reject = check_.check(checked, {.is_there = false, .is_ignored = false});
    if (reject.code != RejectCode::kNone) return refuse(reject);
    has_end_ = checked.kind == BlockKind::kEnd;
    blocks_.push_back(checked);
    return plan();
  }

  [[nodiscard]] Result plan() {
    if (!refusal_.empty()) return refused(refusal_);
    const PlanResult advanced = planner_.advance(writer_);
    if (advanced.status == PlanStatus::kRefused) return refuse(advanced.reject);
    while (!blocks_.empty()) {
      const PlanResult result = planner_.plan(blocks_.front(), writer_);
      drop_reports();
      if (result.status == PlanStatus::kNoRoom) return {};
      if (result.status == PlanStatus::kRefused) return refuse(result.reject);
      blocks_.pop_front();
    }
    return {};
  }

  [[nodiscard]] Result begin() {
    if (!is_at_rest_.load(std::memory_order_acquire)) {
      return refused("the program before is not over; call update() until kDone or kStopped");
    }
    is_at_rest_.store(false, std::memory_order_relaxed);
    begin_planning();
    return {};
  }

  bool request(Verb verb, double argument = 0) noexcept {
    return requests_.try_push({++request_, verb, argument});
  }

  [[nodiscard]] Status update(const Feedback& feedback, Setpoint& setpoint,
                              std::uint32_t lost_periods) noexcept {
    begin_cycle(lost_periods);
    read_feedback(feedback);
    read_request();
    step(model_, state_, reader_, in_, out_);
    setpoint = out_.record.setpoint;
    read_events();
    return status();
  }

  [[nodiscard]] Alarm alarm() const noexcept { return state_.alarm; }
  [[nodiscard]] const CycleRecord& record() const noexcept { return out_.record; }

 private:
  /// Takes the cycle from Off to Ready with drives that stand at `drives`. No setpoint leaves here.
  void get_ready(const JointVector& drives) noexcept {
    for (std::uint64_t i = 0; i < kMaxEnableCycles && state_.state != State::kReady; ++i) {
      begin_cycle(0);
      const std::uint32_t all = all_joints(model_);
      in_.feedback = {.arrival_ns = in_.now_ns,
                      .cycle_seen = in_.cycle - 1,
                      .position = drives,
                      .joint_mask = all,
                      .enabled_mask = is_enabled(state_.state) ? all : 0,
                      .fault_mask = 0,
                      .referenced_mask = all};
      in_.has_command = in_.cycle == kEnableCycle;
      if (in_.has_command) in_.command = {++request_, Verb::kEnable, 0};
      step(model_, state_, reader_, in_, out_);
    }
    rest_ = out_.record.joints;
    rest_epoch_ = state_.epoch;
  }

  void begin_planning() {
    blocks_.clear();
    refusal_.clear();
    has_end_ = false;
    check_.begin(model_.tool_length_mm);
    planner_.begin(rest_, model_.tool_length_mm, rest_epoch_, {});
    writer_.forget_ahead();  // in Ready all that was published has run or is void
  }

  [[nodiscard]] Result refuse(const BlockReject& reject) {
    refusal_ = stream::describe(reject, model_);
    return refused(refusal_);
  }

  /// The planner keeps few reports; here nobody reads them.
  void drop_reports() noexcept {
    for (RelaxedAxis relaxed_axis; planner_.take_relaxed_axis(relaxed_axis);) {
    }
    for (Rewind rewind; planner_.take_rewind(rewind);) {
    }
    for (FeedMark mark; planner_.take_feed_mark(mark);) {
    }
  }

  void begin_cycle(std::uint32_t lost_periods) noexcept {
    in_.lost_periods = lost_periods;
    in_.cycle += 1 + std::uint64_t{lost_periods};
    in_.due_ns = static_cast<std::int64_t>(in_.cycle) * model_.cycle_ns;
    in_.now_ns = in_.due_ns;
  }

  /// Where nothing came the last feedback stays and ages, and the cycle's own watch sees it.
  void read_feedback(const Feedback& feedback) noexcept {
    if (feedback.joint_mask != 0) {
      in_.feedback = feedback;
      in_.feedback.arrival_ns = in_.now_ns;
    }
    if (feedback.emergency_stop) {
      in_.feedback.emergency_stop = true;
      in_.feedback.emergency_ns = in_.now_ns;
    }
  }

  /// A start waits one cycle in Ready, in which the cycle finds the plan.
  void read_request() noexcept {
    in_.has_command = false;
    const Command* next = requests_.peek(0);
    if (next == nullptr) return;
    const bool is_start = next->verb == Verb::kStart;
    if (is_start && state_.state == State::kReady && !has_waited_) {
      has_waited_ = true;
      return;
    }
    has_waited_ = false;
    in_.command = *next;
    in_.has_command = true;
    requests_.drop(1);
  }

  void read_events() noexcept {
    for (std::size_t i = 0; i < out_.event_count; ++i) {
      const Event& event = out_.events[i];
      if (event.code == EventCode::kProgramEnd) phase_ = Phase::kDone;
      if (event.code == EventCode::kAccepted && event.b == static_cast<unsigned>(Verb::kStart)) {
        phase_ = Phase::kStarted;
      }
    }
    const bool is_over = state_.state == State::kReady && phase_ != Phase::kWaiting;
    if (!is_over || is_reported_) {
      is_reported_ = is_over;
      return;
    }
    is_reported_ = true;
    rest_ = state_.joints;
    rest_epoch_ = state_.epoch;
    is_at_rest_.store(true, std::memory_order_release);
  }

  [[nodiscard]] Status status() const noexcept {
    switch (state_.state) {
      case State::kReady:
      case State::kLoaded:
        if (has_waited_) return Status::kRunning;
        if (state_.state == State::kLoaded || phase_ == Phase::kWaiting) return Status::kReady;
        return phase_ == Phase::kDone ? Status::kDone : Status::kStopped;
      case State::kHeld:
      case State::kStepping:
        return Status::kHeld;
      case State::kStarved:
        return Status::kStarved;
      case State::kOff:
      case State::kFault:
        return Status::kFault;
      default:
        return Status::kRunning;
    }
  }

  enum class Phase : std::uint8_t { kWaiting, kStarted, kDone };

  const MachineModel model_;
  const ToolTable tools_;
  // Flags: of two threads. The pushing thread's:
  stream::BlockCheck check_;
  SmoothPlanner planner_;
  MotionPort port_;
  MotionWriter writer_;
  std::deque<ClBlock> blocks_;  ///< checked, not planned yet
  std::string refusal_;
  bool has_end_ = false;
  std::uint64_t request_ = 0;
  // Between the threads. `rest_` is written before `is_at_rest_` is set, and read after.
  SpscRing<Command, 16> requests_;
  std::atomic<bool> is_at_rest_{false};
  JointVector rest_{};
  std::uint16_t rest_epoch_ = 0;
  // The cycle's.
  MotionReader reader_;
  CycleState state_;
  CycleInputs in_;
  StepOutput out_;
  Phase phase_ = Phase::kWaiting;
  bool has_waited_ = false, is_reported_ = false;
};

Interpolator::Interpolator(const MachineModel& model, const ToolTable& tools)
    : Interpolator(model, tools, home_of(model)) {}

Interpolator::Interpolator(const MachineModel& model, const ToolTable& tools,
                           const JointVector& drives)
    : machine_(std::make_unique<Machine>(model, tools, drives)) {}

Interpolator::~Interpolator() = default;

Result Interpolator::push(const ClBlock& block) { return machine_->push(block); }
Result Interpolator::plan() { return machine_->plan(); }
Result Interpolator::begin() { return machine_->begin(); }
bool Interpolator::start() noexcept { return machine_->request(Verb::kStart); }
bool Interpolator::hold() noexcept { return machine_->request(Verb::kHold); }
bool Interpolator::resume() noexcept { return machine_->request(Verb::kResume); }
bool Interpolator::abort() noexcept { return machine_->request(Verb::kAbort); }
bool Interpolator::set_feed_override(double factor) noexcept {
  return machine_->request(Verb::kFeedOverride, factor);
}

Status Interpolator::update(const Feedback& feedback, Setpoint& setpoint,
                            std::uint32_t lost_periods) noexcept {
  return machine_->update(feedback, setpoint, lost_periods);
}

Alarm Interpolator::alarm() const noexcept { return machine_->alarm(); }
const CycleRecord& Interpolator::record() const noexcept { return machine_->record(); }

Feedback ideal_feedback(const MachineModel& model, const Setpoint& setpoint) noexcept {
  const std::uint32_t all = all_joints(model);
  return {.cycle_seen = setpoint.cycle,
          .position = setpoint.position,
          .joint_mask = all,
          .enabled_mask = (setpoint.flags & kSetpointEnabled) != 0 ? all : 0,
          .referenced_mask = all};
}

Feedback ideal_feedback(const MachineModel& model) noexcept {
  Setpoint at_home;
  at_home.position = home_of(model);
  at_home.flags = kSetpointEnabled;
  return ideal_feedback(model, at_home);
}

}  // namespace meridian
