// SPDX-License-Identifier: Apache-2.0
#include "meridian/planner/smooth_planner.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/geometry/unit_vector.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/build_piece.hpp"
#include "service/core/planner/block_window.hpp"
#include "service/core/planner/fault_code.hpp"
#include "service/core/planner/feed_raise.hpp"
#include "service/core/planner/leg_planner.hpp"
#include "service/core/planner/pole_bounds.hpp"
#include "service/core/planner/smooth_run.hpp"

namespace meridian {
namespace {

constexpr double kBesidePole_rad = 0.05;  // kSameAxis turns the free joint by 2e-12 rad there
/// Rounding of joints, in their pose. What is farther off would be a step of the setpoints.
constexpr double kSameTip_mm = 1e-10, kSameAxis = 1e-13;
constexpr std::size_t kUnwindings = 256;  // that wait to be taken; the oldest go
constexpr std::size_t kEases = 256;       // the same

/// Whether there is a branch to choose.
bool has_branches(const MachineModel& model) noexcept { return free_joint(model) >= 0; }

}  // namespace

struct SmoothPlanner::Workspace {
  Workspace(const MachineModel& m, ToolTable t)
      : model(m),
        plain(m, std::move(t)),
        raise(m),
        window(m, has_branches(m)),
        run(m, raise, has_branches(m) ? &window : nullptr),
        plain_eases(kEases),
        unwindings(kUnwindings) {
    if (has_branches(m)) plain.ask(&window);
  }

  [[nodiscard]] BandTolerance tolerance() const noexcept {
    BandTolerance out;
    out.tip_mm =
        settings.tip_tolerance_mm > 0 ? settings.tip_tolerance_mm : model.tolerances.tip_mm;
    out.axis_rad =
        settings.axis_tolerance_rad > 0 ? settings.axis_tolerance_rad : model.tolerances.axis_rad;
    out.tip_mm = std::max(out.tip_mm, kLeastTipTolerance_mm);
    out.axis_rad = std::max(out.axis_rad, kLeastAxisTolerance_rad);
    const bool eases = free_joint(model) >= 0 && model.pole_policy == PolePolicy::kEase;
    if (eases) out.pole = to_array(pole_direction(model));
    return out;
  }

  /// Of the axis beside the pole. What a program asks for holds there too.
  [[nodiscard]] double pole_tolerance_rad() const noexcept {
    const double axis_rad = tolerance().axis_rad;
    return settings.axis_tolerance_rad > 0 ? axis_rad
                                           : std::max(axis_rad, model.tolerances.pole_axis_rad);
  }

  [[nodiscard]] bool is_smooth() const noexcept {
    return settings.transition.value_or(model.transition) == Transition::kSmooth;
  }
  /// `block` as it can be run on through, or nothing where it is done at rest.
  [[nodiscard]] std::optional<ClBlock> smoothable(ClBlock block) const noexcept;
  [[nodiscard]] bool is_on_pole(const Vector3& axis) const noexcept;
  void begin_run(const ClBlock& cut) noexcept;
  void end_run() noexcept;
  /// Publishes what is ready of the run.
  [[nodiscard]] SmoothRun::Status publish(MotionWriter& writer) noexcept;
  /// Turns the free joint back at the rest that the run came to; false: no room in the port, or
  /// refused.
  [[nodiscard]] bool unwind(MotionWriter& writer) noexcept;
  void note(const Unwinding& unwinding) noexcept;
  /// The program begins with what waits; `is_late`: because no more came for too long.
  void end_look(bool is_late) noexcept {
    if (!is_looking) return;
    looked_at = window.waiting();
    if (looked_at > 0) raise.note_look({.looked_at = looked_at, .is_late = is_late});
    is_looking = false;
  }
  /// What is planned waits for blocks behind it: they tell which way past the pole carries.
  [[nodiscard]] bool awaits_ahead() noexcept {
    return (is_running ? run.needs_ahead() : plain.needs_ahead()) && window.is_missing();
  }
  /// Whether `block` is wanted for a look, and not planned at once.
  [[nodiscard]] bool is_looking_at(const ClBlock& block) noexcept {
    if (is_looking) return window.waiting() > 0 || is_motion(block.kind);
    return awaits_ahead();
  }
  /// Whether the look goes on with what comes.
  [[nodiscard]] bool wants_more() noexcept {
    if (!is_looking) return awaits_ahead();
    return window.waiting() != (replayed_look > 0 ? replayed_look : kLookAhead);
  }
  void refuse(const PlanResult& why) noexcept {
    is_refused = true;
    refusal = why;
  }

  const MachineModel& model;
  RestToRestPlanner plain;
  FeedRaise raise;
  BlockWindow window;
  SmoothRun run;
  SmoothSettings settings;
  ToolPose pose{Vector3::Zero(), Vector3::UnitZ()};  ///< end of the last block taken
  JointVector joints{};
  bool is_running = false;
  bool is_for_plain = false;  ///< the block that waits for room goes from rest to rest
  bool has_factor = false;    ///< and has been given the factor of its feed
  bool is_run_on_pole = false;
  bool is_refused = false;
  bool is_ending = false;  ///< no block comes any more
  PlanResult refusal;
  IndexRing<PoleEase> plain_eases;  ///< of blocks from rest to rest
  IndexRing<Unwinding> unwindings;
  bool is_looking = false;          ///< more of the program's begin may come
  std::size_t looked_at = 0;        ///< blocks of the begin
  std::uint64_t replayed_look = 0;  ///< blocks that a run before was begun with; 0: none was
};

std::optional<ClBlock> SmoothPlanner::Workspace::smoothable(ClBlock block) const noexcept {
  if (!is_smooth()) return {};
  if (block.kind != BlockKind::kCut || plain.junction().is_first) return {};
  if (block.feed_meaning == FeedMeaning::kNone || !(block.feed > 0)) return {};
  const auto unit = UnitVector3::near_unit(to_vector(block.axis));
  if (!unit || !to_vector(block.tip_mm).allFinite()) return {};
  Vector3 axis = unit->vector();
  if (block.feed_meaning == FeedMeaning::kTip && model.max_feed_mm_per_s > 0) {
    block.feed = std::min(block.feed, model.max_feed_mm_per_s);
  }
  if (free_joint(model) >= 0 && pole_distance(model, axis) < kPoleEase_rad) {
    axis = find_nearest_pole(model, axis);
  }
  block.axis = to_array(axis);
  // Runs go through the pole and linger on it, or stay on it all the way with the axis fixed. What
  // leads off it from rest is done at rest, where the free joint can turn.
  const bool starts_on_pole = is_on_pole(pose.axis);
  const bool may_linger = model.pole_policy == PolePolicy::kEase;
  if (axis == pose.axis) {
    const bool may_go_on = !starts_on_pole || !is_running || is_run_on_pole || may_linger;
    return may_go_on ? std::optional(block) : std::nullopt;
  }
  if (!find_great_circle(pose.axis, axis).is_unique) return {};
  if (is_running && is_run_on_pole) return {};
  if (starts_on_pole && !(is_on_pole(axis) ? may_linger : is_running)) return {};
  return block;
}

bool SmoothPlanner::Workspace::is_on_pole(const Vector3& axis) const noexcept {
  return free_joint(model) >= 0 &&
         pole_distance(model, axis) < kOnPoleTolerances * tolerance().axis_rad;
}

void SmoothPlanner::Workspace::begin_run(const ClBlock& cut) noexcept {
  const RestToRestPlanner::Junction at = plain.junction();
  RunStart start;
  start.pose = at.pose;
  start.joints = at.joints;
  start.tool_length_mm = at.tool_length_mm;
  start.epoch = at.epoch;
  start.path_index = at.path_index;
  start.window = at.window;
  double nearest = 1e300;
  for (int branch = 0; branch < branch_count(model); ++branch) {
    const auto found = solve(model, at.tool_length_mm, at.pose, branch, at.joints);
    if (found.status == SolveStatus::kUnreachable) continue;
    double off = 0;
    for (int i = 0; i < model.joint_count; ++i) {
      off = std::max(off, std::abs(found.q[i] - at.joints[i]));
    }
    if (off < nearest) {
      nearest = off;
      start.branch = branch;
    }
  }
  start.is_on_pole = is_run_on_pole = is_on_pole(pose.axis) && to_vector(cut.axis) == pose.axis;
  run.begin(start, tolerance(), pole_tolerance_rad());
  is_running = true;
}

void SmoothPlanner::Workspace::end_run() noexcept {
  RestToRestPlanner::Junction at = plain.junction();
  at.joints = joints = run.joints();
  // Eased beside the pole, or behind a block too short for a span, the tool is not quite where the
  // last block put it: what follows starts from where it is.
  // Beside the pole rounding of the axis alone turns the free joint.
  const ToolPose there = forward(model, at.tool_length_mm, joints);
  const double from_pole = free_joint(model) >= 0 ? pole_distance(model, pose.axis) : 1;
  const bool is_beside_pole = from_pole >= kPoleEase_rad && from_pole < kBesidePole_rad;
  const bool is_same =
      (there.tip - pose.tip).norm() <= kSameTip_mm && (there.axis - pose.axis).norm() <= kSameAxis;
  if (is_beside_pole || !is_same) pose = there;
  at.pose = pose;
  at.path_index = run.next_path_index();
  at.window = run.next_window();
  plain.continue_at(at);
  is_running = false;
}

SmoothRun::Status SmoothPlanner::Workspace::publish(MotionWriter& writer) noexcept {
  for (;;) {
    const SmoothRun::Status status = run.publish(writer);
    if (status == SmoothRun::Status::kUnwind) {
      if (!is_refused && unwind(writer)) continue;
      return is_refused ? SmoothRun::Status::kFailed : SmoothRun::Status::kNoRoom;
    }
    if (run.has_fault() && !is_refused) {
      BlockReject reject = run.faulty_block();
      reject.code = code_of(run.fault().kind);
      refuse({PlanStatus::kRefused, reject, 0, {}});
    }
    return status;
  }
}

bool SmoothPlanner::Workspace::unwind(MotionWriter& writer) noexcept {
  RestToRestPlanner::Junction at = plain.junction();
  at.joints = run.joints();
  at.pose = forward(model, at.tool_length_mm, at.joints);
  at.path_index = run.next_path_index();
  at.window = run.next_window();
  plain.continue_at(at);
  const BlockReject& where = run.unwind_at();
  ClBlock block;
  block.sequence = where.sequence;
  block.line = where.line;
  const PlanResult result = plain.unwind(block, where.value, run, writer);
  if (result.status == PlanStatus::kRefused) refuse(result);
  if (result.status != PlanStatus::kOk) return false;
  note(result.unwinding);
  const RestToRestPlanner::Junction behind = plain.junction();
  run.go_on(behind.joints, result.unwinding.turns, behind.path_index, behind.window);
  return true;
}

void SmoothPlanner::Workspace::note(const Unwinding& unwinding) noexcept {
  if (unwinding.turns == 0) return;
  unwindings.push_over_oldest(unwinding);
}

SmoothPlanner::SmoothPlanner(const MachineModel& model, ToolTable tools)
    : workspace_(std::make_unique<Workspace>(model, std::move(tools))) {}

SmoothPlanner::~SmoothPlanner() = default;

void SmoothPlanner::begin(const JointVector& at_rest, double tool_length_mm, std::uint16_t epoch,
                          const SmoothSettings& settings) noexcept {
  Workspace& w = *workspace_;
  if (w.is_running) w.end_run();  // no index comes twice
  w.plain.begin(at_rest, tool_length_mm, epoch, settings.retracts_first);
  w.settings = settings;
  const bool may_ease = w.is_smooth() && w.model.pole_policy == PolePolicy::kEase;
  if (may_ease) w.plain.set_free_cone(kOnPoleTolerances * w.tolerance().axis_rad);
  w.raise.begin();
  w.is_refused = w.is_for_plain = w.has_factor = w.is_ending = false;
  w.window.begin(w.is_smooth() ? AheadSlack{w.tolerance().tip_mm, w.pole_tolerance_rad()}
                               : AheadSlack{});
  w.looked_at = 0;
  w.is_looking = has_branches(w.model);
  w.pose = w.plain.junction().pose;
  w.joints = at_rest;
}

PlanResult SmoothPlanner::plan(const ClBlock& block, MotionWriter& writer) noexcept {
  Workspace& w = *workspace_;
  if (w.is_refused) return w.refusal;
  if (block.kind == BlockKind::kEnd) w.window.end();
  bool is_taken = false;
  if (w.is_looking_at(block)) {
    // Without memory for the block: it is the last one, or the look is full.
    is_taken = block.kind != BlockKind::kEnd && w.window.waiting() < kLookAhead;
    if (is_taken) w.window.push(block);
    if (is_taken && w.wants_more()) return {};
    w.end_look(false);
  }
  const bool is_planned = plan_what_waits(writer);
  if (w.is_refused) return w.refusal;
  if (is_taken) return {};
  if (!is_planned) return {PlanStatus::kNoRoom, {}, 0, {}};
  const PlanResult result = plan_one(block, writer);
  if (result.status == PlanStatus::kOk && !w.is_looking) w.window.keep(block);
  return result;
}

bool SmoothPlanner::plan_what_waits(MotionWriter& writer) noexcept {
  Workspace& w = *workspace_;
  if (w.window.waiting() == 0) return true;
  const auto begin = w.window.first(w.looked_at);
  if (w.is_smooth()) {
    w.plain.look_at(begin, w.tolerance().tip_mm, w.pole_tolerance_rad());
  } else {
    w.plain.look_at(begin);
  }
  while (w.window.waiting() > 0) {
    if (plan_one(w.window.front(), writer).status != PlanStatus::kOk) return false;
    w.window.pop();
  }
  w.plain.look_at({});
  return true;
}

void SmoothPlanner::look_no_further() noexcept {
  Workspace& w = *workspace_;
  w.end_look(true);
  if (!w.awaits_ahead()) return;
  if (const auto mark = w.window.look_no_further()) w.raise.note_look(*mark);
}

std::uint64_t SmoothPlanner::look() const noexcept {
  Workspace& w = *workspace_;
  if (w.is_looking) return w.window.waiting() > 0 ? 1 : 0;
  return w.awaits_ahead() ? 1 + w.window.questions() : 0;
}

void SmoothPlanner::finish() noexcept {
  Workspace& w = *workspace_;
  if (!w.is_looking) look_no_further();
  w.window.end();
  w.end_look(false);
  w.is_ending = true;
}

PlanResult SmoothPlanner::plan_one(const ClBlock& block, MotionWriter& writer) noexcept {
  using Status = SmoothRun::Status;
  Workspace& w = *workspace_;
  if (w.is_refused) return w.refusal;
  // Decided once: what the answer depends on changes where the port was full meanwhile.
  auto cut = w.is_for_plain ? std::nullopt : w.smoothable(block);
  w.is_for_plain = !cut;
  if (w.is_running) {
    if (!cut) w.run.finish();
    const Status status = w.publish(writer);
    if (w.is_refused) return w.refusal;
    if (status == Status::kNoRoom || (!cut && status != Status::kDone) || w.awaits_ahead())
      return {PlanStatus::kNoRoom, {}, 0, {}};
    if (!cut) {
      w.end_run();
      cut = w.smoothable(block);  // it may start a run of its own
      w.is_for_plain = !cut;
    }
  }
  if (!cut) {
    if (w.awaits_ahead()) return {PlanStatus::kNoRoom, {}, 0, {}};
    if (!w.has_factor && block.kind == BlockKind::kCut) {
      w.raise.rest();
      w.plain.set_feed_factor(w.raise.next(block.sequence, writer.feed_override(), 0).label);
    }
    const PlanResult result = w.plain.plan(block, writer);
    w.is_for_plain = w.has_factor = result.status == PlanStatus::kNoRoom;
    if (result.status == PlanStatus::kRefused) {
      w.refuse(result);
    } else if (result.status == PlanStatus::kOk) {
      w.note(result.unwinding);
      w.pose = w.plain.junction().pose;
      w.joints = w.plain.joints();
      if (result.axis_deviation_rad > 0) {
        w.plain_eases.push_over_oldest({block.sequence, block.sequence, block.line, block.line,
                                        result.axis_deviation_rad, EaseReason::kOnPole});
      }
    }
    return result;
  }
  if (!w.is_running) w.begin_run(*cut);
  w.run.take(*cut);
  w.pose = {to_vector(cut->tip_mm), to_vector(cut->axis)};
  (void)w.publish(writer);
  return w.is_refused ? w.refusal : PlanResult{};
}

PlanResult SmoothPlanner::advance(MotionWriter& writer) noexcept {
  Workspace& w = *workspace_;
  if (w.is_looking) return {};
  const bool is_planned = w.is_refused || plan_what_waits(writer);
  if (is_planned && w.is_running) {
    if (w.is_ending && !w.is_refused) w.run.finish();
    (void)w.publish(writer);
  }
  return w.is_refused ? w.refusal : PlanResult{};
}

bool SmoothPlanner::take_approach(Approach& out) noexcept {
  return workspace_->plain.take_approach(out);
}

bool SmoothPlanner::take_unwinding(Unwinding& out) noexcept {
  return workspace_->unwindings.take_oldest(out);
}

bool SmoothPlanner::take_ease(PoleEase& out) noexcept {
  Workspace& w = *workspace_;
  return w.run.take_ease(out) || w.plain_eases.take_oldest(out);
}

bool SmoothPlanner::take_feed_mark(FeedMark& out) noexcept { return workspace_->raise.take(out); }

void SmoothPlanner::replay_feed(std::span<const FeedMark> marks) noexcept {
  Workspace& w = *workspace_;
  w.raise.replay(marks);
  w.window.replay(marks);
  w.replayed_look = 0;
  for (const FeedMark& mark : marks) {
    if (mark.looked_at > 0 && mark.sequence == 0)
      w.replayed_look = std::min<std::uint64_t>(mark.looked_at, kLookAhead);
  }
}

const JointVector& SmoothPlanner::joints() const noexcept { return workspace_->joints; }

double SmoothPlanner::tool_length_mm() const noexcept { return workspace_->plain.tool_length_mm(); }

}  // namespace meridian
