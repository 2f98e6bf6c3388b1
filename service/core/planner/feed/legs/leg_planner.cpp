// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/legs/leg_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/joints_at.hpp"
#include "service/core/planner/feed/stop/stop_margin_table.hpp"

namespace meridian {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kGrading = 0.7;      // step between nodes, in distances to the pole
constexpr double kCellGrading = 0.1;  // step between cells
constexpr double kCellTurn_rad = 0.06;
constexpr double kCellSweep_rad = 0.14;
constexpr double kCellFree_rad = 0.14;
constexpr double kLargestAzimuth_rad = 1.565;  // 5.8 mrad short of a quarter turn
constexpr double kMaxLegCells = 256;
constexpr double kGain = 1.01;      // over the least time, that constant bounds may lose
constexpr double kRests_s = 0.004;  // and that much more, for which it is not asked
constexpr double kCoarse = 1.12;
constexpr int kMaxRefinements = 3;
constexpr int kMinAzimuthCells = 4;  // between two nodes
/// Rounding of the redundant joint 8 µrad from the pole is 1e-10, of slides that make up for it so
/// much of their way to its axis.
constexpr double kLargestJump_rad = 1e-9, kLargestJump_mm = 1e-7;
/// A motion creeps that takes longer than this, and so many times longer than its length takes at
/// the programmed feed, and than its joints take from end to end at their velocity.
constexpr double kCreep_s = 10, kCreepOfFeed = 1000, kCreepOfJoints = 10;

int cells_for(double amount) noexcept {
  return static_cast<int>(std::clamp(std::ceil(amount), 1.0, kMaxLegCells));
}

/// Distance to the pole at `from_nearest` along the great circle.
double distance_at(double offset, double from_nearest) noexcept {
  return std::hypot(offset, std::sin(from_nearest));
}

/// Beside a singularity that the leg is not cut for: no joint has far to go, nor has the tool, and
/// the rate between them bounds the motion to next to nothing.
bool creeps(const MachineModel& model, const PathPiece& piece, double duration,
            double feed_mm_per_s) noexcept {
  if (!(duration > kCreep_s) || !(feed_mm_per_s > 0)) return false;
  if (duration < kCreepOfFeed * piece.length / feed_mm_per_s) return false;
  double joints_s = 0;
  for (int i = 0; i < model.joint_count; ++i) {
    const double by = std::abs(piece.joints_end[i] - piece.joints_begin[i]);
    joints_s = std::max(joints_s, by / model.joints[i].limits.velocity);
  }
  return duration > kCreepOfJoints * joints_s;
}

bool is_solved(const PathPiece& path) noexcept {
  return (path.kind == PathKind::kLine || path.kind == PathKind::kArc) && !path.is_free_driven;
}

}  // namespace

Vector3 find_nearest_pole(const MachineModel& model, const Vector3& axis) noexcept {
  const Vector3 pole = pole_direction(model);
  return pole.dot(axis) < 0 ? Vector3(-pole) : pole;
}

LegPlanner::LegPlanner(const MachineModel& model) : model_(model), feed_(model) {}

PathFault LegPlanner::plan(const Leg& leg, Staging& out, JointVector& joints) noexcept {
  const double reach =
      std::max(pose_in_machine(model_, pose_at(leg.path, 0.0)).tip.norm(),
               pose_in_machine(model_, pose_at(leg.path, leg.path.length)).tip.norm());
  caps_ = planned_caps(model_, reach);
  fault_caps_ = fault_caps(model_, reach);
  set_nodes(leg.path);
  JointVector at_end = joints;
  if (const auto fault = measure(leg, at_end); fault.kind != PathFault::Kind::kNone) return fault;
  find_fastest_runs(leg);
  return plan_feed(leg, out, joints) ? PathFault{} : stage_runs(leg, out, joints);
}

bool LegPlanner::plan_feed(const Leg& leg, Staging& out, JointVector& joints) noexcept {
  const double fastest = nodes_[node_count_ - 1].fastest;
  if (fastest <= kGain * min_leg_time(leg, cells_.all(), caps_) + kRests_s) return false;
  const Staging::Mark mark = out.mark();
  JointVector at_end = joints;
  const double duration = feed_.plan(leg, cells_.all(), fastest, out, at_end);
  if (!(duration > 0)) return false;
  if (creeps(model_, out.paths[mark.paths], duration, leg.tip_feed())) {
    out.go_back(mark);
    return false;
  }
  joints = at_end;
  return true;
}

PathFault LegPlanner::stage_runs(const Leg& leg, Staging& out, JointVector& joints) noexcept {
  // The way back gives the runs last to first: turn it round in place.
  int runs = 0;
  std::array<int, kMaxNodes> route;
  for (int n = node_count_ - 1; n > 0; n = nodes_[n].from) route[runs++] = n;
  for (int n = runs - 1; n >= 0; --n) {
    const Node& to = nodes_[route[n]];
    const PathFault fault = stage_run(leg, nodes_[to.from], to, out, joints);
    if (is_fault(fault)) return fault;
  }
  return {};
}

void LegPlanner::set_nodes(const PathPiece& path) noexcept {
  const double turn = path.axis_turn;
  node_count_ = 0;
  const auto add = [&](double at) {
    Node& node = nodes_[node_count_++];
    node = {};
    node.turn = at;
    node.s = turn > 0 ? path.length * (at / turn) : 0;
  };
  add(0);
  if (is_solved(path) && turn > 0) {
    passage_ = find_passage(path, find_nearest_pole(model_, to_vector(path.axis_begin)));
    const double nearest = passage_.nearest_turn, offset = passage_.offset;
    std::array<double, kMaxNodes / 2 - 2> graded;
    int count = 0;
    for (double u = 0.6 * offset; u < 2 * turn + 2 && count < static_cast<int>(graded.size());
         u += kGrading * std::hypot(offset, u)) {
      graded[count++] = u;
    }
    const auto add_inside = [&](double from_nearest) {
      const double at = nearest + from_nearest;
      const double sliver = 0.25 * kGrading * distance_at(offset, from_nearest);
      if (at > nodes_[node_count_ - 1].turn + sliver && at < turn - sliver) add(at);
    };
    for (int n = count - 1; n >= 0; --n) add_inside(-graded[n]);
    for (int n = 0; n < count; ++n) add_inside(graded[n]);
  } else {
    passage_ = {};
  }
  add(turn);
  nodes_[node_count_ - 1].s = path.length;
  if (node_count_ == 2) return;
  for (int n = 0; n < node_count_; ++n) {
    const double u = nodes_[n].turn - passage_.nearest_turn;
    nodes_[n].azimuth = atan2(std::sin(u), passage_.offset * std::cos(u));
    nodes_[n].has_azimuth = std::abs(nodes_[n].azimuth) < kLargestAzimuth_rad;
  }
}

/// Takes more cells where the limits of the path change much from end to end of one.
PathFault LegPlanner::append_cells(CellTable& table, const PathPiece& path, double begin,
                                   double end, int cells, JointVector& joints) noexcept {
  const int first = table.size();
  const JointVector at_begin = joints;
  for (int round = 0;; ++round) {
    const PathFault fault = table.append(model_, path, begin, end, cells, joints);
    const bool is_jump = fault.kind == PathFault::Kind::kJump;
    const bool is_coarse = is_jump || (table.coarseness() > kCoarse && !is_fault(fault));
    if (!is_coarse || round == kMaxRefinements || first + 2 * cells > kMaxLegCells) {
      return fault;
    }
    table.go_back(first);
    joints = at_begin;
    cells *= 2;
  }
}

PathFault LegPlanner::measure(const Leg& leg, JointVector& joints) noexcept {
  const PathPiece& path = leg.path;
  cells_.clear();
  azimuth_cells_.clear();
  PathPiece by_azimuth;
  double azimuth_from = 0;
  bool is_begun = false;
  for (int n = 0; n + 1 < node_count_; ++n) {
    Node& a = nodes_[n];
    const Node& b = nodes_[n + 1];
    a.cell = cells_.size();
    a.azimuth_cell = azimuth_cells_.size();
    const double share = path.length > 0 ? (b.s - a.s) / path.length : 1.0;
    double amount = std::max({share * std::abs(path.arc_sweep) / kCellSweep_rad,
                              share * path.axis_turn / kCellTurn_rad,
                              std::abs(share * (path.free_end - path.free_begin)) / kCellFree_rad});
    if (path.kind == PathKind::kJoint && has_stage(model_)) {
      // The joints are linear in s and the drives of the stage are not.
      const auto turned = static_cast<std::size_t>(model_.stage.rotary_joint);
      const double by = path.joints_end[turned] - path.joints_begin[turned];
      amount = std::max(amount, std::abs(share * by) / kCellFree_rad);
    }
    if (is_solved(path) && path.axis_turn > 0) {
      const double near = std::min(distance_at(passage_.offset, a.turn - passage_.nearest_turn),
                                   distance_at(passage_.offset, b.turn - passage_.nearest_turn));
      amount = std::max(amount, (b.turn - a.turn) / (kCellGrading * near));
    }
    const JointVector at_begin = joints;
    const PathFault fault = append_cells(cells_, path, a.s, b.s, cells_for(amount), joints);
    if (fault.kind != PathFault::Kind::kNone) return fault;
    if (!a.has_azimuth || !b.has_azimuth) continue;
    if (!is_begun) {
      // One piece over all nodes near enough, so that its s counts through.
      int last = n;
      while (last + 1 < node_count_ && nodes_[last + 1].has_azimuth) ++last;
      azimuth_from = a.azimuth;
      by_azimuth = cut_by_azimuth(path, passage_, azimuth_from, nodes_[last].azimuth);
      is_begun = true;
    }
    JointVector at = at_begin;
    const PathFault azimuth_fault = append_cells(
        azimuth_cells_, by_azimuth, kAxisLength_mm_per_rad * (a.azimuth - azimuth_from),
        kAxisLength_mm_per_rad * (b.azimuth - azimuth_from),
        std::max(kMinAzimuthCells, cells_for((b.azimuth - a.azimuth) / kCellFree_rad)), at);
    if (azimuth_fault.kind != PathFault::Kind::kNone) return azimuth_fault;
  }
  nodes_[node_count_ - 1].cell = cells_.size();
  nodes_[node_count_ - 1].azimuth_cell = azimuth_cells_.size();
  return {};
}

MotionChoice LegPlanner::choose(const Leg& leg, std::span<const JointCell> cells,
                                double length) const noexcept {
  double share_rate = 0;
  for (const JointCell& cell : cells) share_rate = std::max(share_rate, cell.share_rate);
  return choose_motion(cells, caps_, length, leg.max_velocity(share_rate));
}

void LegPlanner::relax_from(int first, bool by_azimuth, const Leg& leg) noexcept {
  const CellTable& table = by_azimuth ? azimuth_cells_ : cells_;
  JointCell whole{};
  bool is_begun = false;
  for (int last = first + 1; last < node_count_; ++last) {
    const Node& before = nodes_[last - 1];
    Node& to = nodes_[last];
    if (by_azimuth && !(before.has_azimuth && to.has_azimuth)) break;
    const auto cells = by_azimuth ? table.range(before.azimuth_cell, to.azimuth_cell)
                                  : table.range(before.cell, to.cell);
    for (const JointCell& cell : cells) {
      whole = is_begun ? merged(whole, cell) : cell;
      is_begun = true;
    }
    const MotionChoice choice = choose(leg, {&whole, 1}, whole.end - whole.begin);
    if (choice.profile.jerk == 0) break;
    const double time = choice.profile.duration();
    if (nodes_[first].fastest + time < to.fastest) {
      to.fastest = nodes_[first].fastest + time;
      to.from = first;
      to.by_azimuth = by_azimuth;
    } else if (!by_azimuth && time > to.fastest) {
      break;  // longer runs from here are slower still
    }
  }
}

void LegPlanner::find_fastest_runs(const Leg& leg) noexcept {
  for (int n = 1; n < node_count_; ++n) {
    nodes_[n].fastest = kUnbounded;
    nodes_[n].from = n - 1;
    nodes_[n].by_azimuth = false;
  }
  nodes_[0].fastest = 0;
  if (node_count_ == 2) {
    whole_ = choose(leg, cells_.all(), leg.path.length);
    if (whole_.profile.jerk > 0) nodes_[1].fastest = whole_.profile.duration();
    return;
  }
  for (int n = 0; n + 1 < node_count_; ++n) {
    relax_from(n, false, leg);
    if (nodes_[n].has_azimuth) relax_from(n, true, leg);
  }
}

PathFault LegPlanner::stage_run(const Leg& leg, const Node& from, const Node& to, Staging& out,
                                JointVector& joints) noexcept {
  const double turn = leg.path.axis_turn;
  const bool is_whole = node_count_ == 2;
  PathPiece piece = leg.path;
  if (to.by_azimuth) {
    piece = cut_by_azimuth(leg.path, passage_, from.azimuth, to.azimuth);
  } else if (!is_whole) {
    const bool is_last = &to == &nodes_[node_count_ - 1];
    piece = cut_piece(leg.path, from.turn / turn, is_last ? 1.0 : to.turn / turn);
  }
  const auto cells = to.by_azimuth ? azimuth_cells_.range(from.azimuth_cell, to.azimuth_cell)
                                   : cells_.range(from.cell, to.cell);
  const MotionChoice choice = is_whole ? whole_ : choose(leg, cells, piece.length);
  if (choice.profile.jerk == 0) return {PathFault::Kind::kTooLong, -1, 0};
  const auto begin = joints_at(model_, piece, 0.0, joints);
  const auto end = joints_at(model_, piece, 0.5 * piece.length, begin.q);
  for (int i = 0; i < model_.joint_count; ++i) {
    const double jump = begin.q[i] - joints[i];
    const double largest = model_.joints[i].is_rotary ? kLargestJump_rad : kLargestJump_mm;
    if (!(std::abs(jump) < largest)) return {PathFault::Kind::kJump, i, jump};
  }
  piece.joints_begin = begin.q;
  piece.joints_end = joints_at(model_, piece, piece.length, end.q).q;
  if (creeps(model_, piece, choice.profile.duration(), leg.tip_feed())) {
    return {PathFault::Kind::kJump, -1, 0};
  }
  piece.index = out.first_index + static_cast<std::uint64_t>(out.path_count);
  if (!out.add(piece) || !stage_times(leg, piece, choice, cells, cells.front().begin, out)) {
    return {PathFault::Kind::kTooLong, -1, 0};
  }
  joints = piece.joints_end;
  return {};
}

bool LegPlanner::stage_times(const Leg& leg, const PathPiece& piece, const MotionChoice& choice,
                             std::span<const JointCell> cells, double offset,
                             Staging& out) const noexcept {
  TimePiece time = leg.time_on(piece);
  const StopMarginTable margin(cells, offset, caps_, fault_caps_, choice);
  const ProfilePhases phases = phases_of(choice.profile, piece.length);
  for (int n = 0; n < phases.count; ++n) {
    const ProfilePhase& phase = phases.phase[n];
    const StopMarginTable::Cuts cuts = margin.cut(phase);
    for (int k = 0; k <= cuts.count; ++k) {
      const double t = k == 0 ? 0 : cuts.time[k - 1];
      time.duration = (k == cuts.count ? phase.duration : cuts.time[k]) - t;
      time.s0 = phase.s + t * (phase.v + t * (phase.a / 2 + t * phase.j / 6));
      time.v = phase.v + t * (phase.a + t * phase.j / 2);
      time.a = phase.a + t * phase.j;
      time.j = phase.j;
      margin.grant(time);
      if (!out.add(time)) return false;
    }
  }
  return true;
}

}  // namespace meridian
