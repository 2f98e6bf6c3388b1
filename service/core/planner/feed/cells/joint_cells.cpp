// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/joint_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/joints_at.hpp"

namespace meridian {
namespace {

constexpr double kJointNoise_rad = 1e-9;  // of a robot's joint, well off its singular places
constexpr double kChainNoise = 1e-5;      // of a chain's joint beside its pole too, mm or rad
constexpr double kMaxOff = 0.01;          // of a joint between samples, of what it bends by
constexpr double kBetween = 1.25;         // of a second derivative, over what both ends say

/// Joints and drives of the stage, and their derivatives, at one place.
struct Sample {
  double share_rate = 0;
  JointVector joints{};
  LimitedVector q, d1, d2, d3;  ///< filled as far as limited_count()

  [[nodiscard]] JointDerivatives derivatives() const noexcept { return {q, d1, d2, d3}; }

  void set(int i, const Jet<3>& x) noexcept {
    q[i] = x.derivative(0);
    d1[i] = x.derivative(1);
    d2[i] = x.derivative(2);
    d3[i] = x.derivative(3);
  }
};

bool take_sample(const MachineModel& model, const PathPiece& piece, double s,
                 const JointVector& reference, Sample& out) noexcept {
  const auto at = joints_at(model, piece, Jet<3>::variable(s), reference);
  if (at.status == SolveStatus::kUnreachable) return false;
  for (int i = 0; i < model.joint_count; ++i) {
    out.set(i, at.q[i]);
    out.joints[i] = value_of(at.q[i]);
  }
  if (has_stage(model)) {
    const Limited<Jet<3>> all = limited_of(model, at.q);
    for (int i = model.joint_count; i < limited_count(model); ++i) out.set(i, all[i]);
  }
  out.share_rate = fraction_at(piece, Jet<1>::variable(s)).derivative(1);
  return true;
}

PathFault check_travel(const MachineModel& model, const LimitedVector& q) noexcept {
  for (int i = 0; i < limited_count(model); ++i) {
    if (!is_inside_travel(limited_spec(model, i), q[i], kTravelMargin)) {
      return {PathFault::Kind::kTravel, i, q[i]};
    }
  }
  return {};
}

/// Largest of three samples of a smooth function, raised by what it may do between them.
double bound(double a, double b, double c) noexcept {
  const double largest = std::max({std::abs(a), std::abs(b), std::abs(c)});
  return largest + 0.25 * (std::max({a, b, c}) - std::min({a, b, c}));
}

/// What moving along the path asks of the joint that it asks most of: 1 / (s̈ that is possible).
double hardness(const MachineModel& model, const LimitedVector& d1) noexcept {
  double hardest = 0;
  for (int i = 0; i < limited_count(model); ++i) {
    hardest = std::max(hardest, std::abs(d1[i]) / limited_spec(model, i).limits.acceleration);
  }
  return hardest;
}

/// The linear joint that goes farthest where the three lie in one plane between `a` and `b`, which
/// turns their volume over; -1: they do not.
int slide_turned_over(const ChainKinematics& k, const LimitedVector& a,
                      const LimitedVector& b) noexcept {
  if (!k.slides_align) return -1;
  JointVector from{}, to{};
  int farthest = k.linear[0].joint;
  for (std::size_t i = 0; i < from.size(); ++i) {
    from[i] = a[i];
    to[i] = b[i];
  }
  if (chain::slide_volume(k, from) * chain::slide_volume(k, to) > 0) return -1;
  for (const ChainKinematics::Linear& linear : k.linear) {
    const int i = linear.joint;
    if (std::abs(b[i] - a[i]) > std::abs(b[farthest] - a[farthest])) farthest = i;
  }
  return farthest;
}

double axis_noise(const MachineModel& model, const PathPiece& piece, double begin,
                  double end) noexcept {
  const bool is_solved = piece.kind == PathKind::kLine || piece.kind == PathKind::kArc;
  const bool turns = piece.kind == PathKind::kSpline || (is_solved && piece.axis_turn != 0);
  if (!turns || piece.is_free_driven) return 0;
  const double distance = std::min({pole_distance(model, pose_at(piece, begin).axis),
                                    pole_distance(model, pose_at(piece, 0.5 * (begin + end)).axis),
                                    pole_distance(model, pose_at(piece, end).axis)});
  return distance > 0 ? kAxisNoise / distance : 0;
}

}  // namespace

PathFault check_turns(const MachineModel& model, const LimitedVector& a, const LimitedVector& da,
                      const LimitedVector& b, const LimitedVector& db, double h) noexcept {
  for (int i = 0; i < limited_count(model); ++i) {
    if (!(da[i] * db[i] < 0)) continue;
    // Value of the cubic through both samples where its derivative vanishes (secant).
    const double t = da[i] / (da[i] - db[i]);
    const double by = b[i] - a[i];
    const double q =
        a[i] + by * t * t * (3 - 2 * t) + h * t * (1 - t) * ((1 - t) * da[i] - t * db[i]);
    if (!is_inside_travel(limited_spec(model, i), q, kTravelMargin)) {
      return {PathFault::Kind::kTravel, i, q};
    }
  }
  return {};
}

PathFault check_joins(const MachineModel& model, const JointDerivatives& a,
                      const JointDerivatives& b, double h) noexcept {
  if (!has_inner_singularities(model)) return {};
  if (model.family == MachineFamily::kChain) {
    const int slide = slide_turned_over(model.chain, a.q, b.q);
    if (slide >= 0) return {PathFault::Kind::kJump, slide, b.q[slide] - a.q[slide]};
    if (redundant_joint(model) >= 0) return {};
  }
  const double noise = model.family == MachineFamily::kRobot ? kJointNoise_rad : kChainNoise;
  for (int i = 0; i < model.joint_count; ++i) {
    const double by = b.q[i] - a.q[i];
    const double off = std::abs(by - 0.5 * h * (a.d1[i] + b.d1[i] + h / 6 * (a.d2[i] - b.d2[i])));
    // A share of what the derivatives bend the joint by, and rounding. Closely beside the base axis
    // the higher ones are as large as one pleases: no bend may exceed the way of the joint itself.
    const double bend =
        std::abs(b.d1[i] - a.d1[i]) + h * (std::max(std::abs(a.d2[i]), std::abs(b.d2[i])) +
                                           h * std::max(std::abs(a.d3[i]), std::abs(b.d3[i])));
    const double rate = std::abs(by) / h + std::abs(a.d1[i]) + std::abs(b.d1[i]);
    if (!(off <= noise + kMaxOff * h * std::min(bend, rate))) {
      return {PathFault::Kind::kJump, i, by};
    }
  }
  return {};
}

PathFault check_keep_out(const MachineModel& model, const JointDerivatives& a,
                         const JointDerivatives& b, double h) noexcept {
  JointVector from{}, to{}, off{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(model.joint_count); ++i) {
    from[i] = a.q[i];
    to[i] = b.q[i];
    const double bend = std::max(std::abs(a.d2[i]), std::abs(b.d2[i])) +
                        0.5 * h * std::max(std::abs(a.d3[i]), std::abs(b.d3[i]));
    const double by = kBetween * h * h / 8 * bend;
    off[i] = std::isfinite(by) ? by : std::numeric_limits<double>::infinity();
  }
  const int box = keep_out_between(model.keep_out, from, to, off).box;
  return box < 0 ? PathFault{} : PathFault{PathFault::Kind::kKeepOut, -1, 1.0 * box};
}

PathFault check_tip_box(const MachineModel& model, double tool_length_mm, const JointDerivatives& a,
                        const JointDerivatives& b, double h) noexcept {
  const auto tip_of = [&](const JointDerivatives& derivatives) {
    Joints<Jet<3>> q;
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] = Jet<3>::from_derivatives(
          {derivatives.q[i], derivatives.d1[i], derivatives.d2[i], derivatives.d3[i]});
    }
    return tip_over_base(model, tool_length_mm, q);
  };
  const std::array<Jet<3>, 3> from = tip_of(a), to = tip_of(b);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const auto larger = [&](int order) {
      return std::max(std::abs(from[i].derivative(order)), std::abs(to[i].derivative(order)));
    };
    const TipStep step{value_of(from[i]), value_of(to[i]), from[i].derivative(1),
                       to[i].derivative(1), kBetween * (larger(2) + 0.5 * h * larger(3))};
    if (!(beyond_over_step(model.tip_box, i, step, h) <= kTipBoxRounding)) {
      const bool is_end = beyond_face(model.tip_box, i, step.to) > kTipBoxRounding;
      return {PathFault::Kind::kTipBox, static_cast<int>(i), is_end ? step.to : step.from};
    }
  }
  return {};
}

PathFault check_boxes(const MachineModel& model, double tool_length_mm, const JointDerivatives& a,
                      const JointDerivatives& b, double h) noexcept {
  PathFault fault;
  if (!model.keep_out.empty()) fault = check_keep_out(model, a, b, h);
  if (model.tip_box.is_set && !is_fault(fault)) {
    fault = check_tip_box(model, tool_length_mm, a, b, h);
  }
  return fault;
}

PathFault CellTable::append(const MachineModel& model, const PathPiece& piece, double begin,
                            double end, int cells, JointVector& joints) noexcept {
  if (count_ + cells > kCapacity) return {PathFault::Kind::kTooLong, -1, 0};
  Sample at[3];
  if (!take_sample(model, piece, begin, joints, at[2])) {
    return {PathFault::Kind::kUnreachable, -1, 0};
  }
  if (const auto fault = check_travel(model, at[2].q); fault.kind != PathFault::Kind::kNone) {
    return fault;
  }
  coarseness_ = 1;
  const double h = (end - begin) / cells;
  const int count = limited_count(model);
  const bool is_boxed = has_boxes(model);
  for (int n = 0; n < cells; ++n) {
    at[0] = at[2];
    JointCell& cell = cells_[count_++];
    cell.begin = begin + n * h;
    cell.end = n + 1 == cells ? end : begin + (n + 1) * h;
    for (int k = 1; k <= 2; ++k) {
      const double s = k == 2 ? cell.end : 0.5 * (cell.begin + cell.end);
      if (!take_sample(model, piece, s, at[k - 1].joints, at[k])) {
        return {PathFault::Kind::kUnreachable, -1, 0};
      }
      PathFault fault = check_turns(model, at[k - 1].q, at[k - 1].d1, at[k].q, at[k].d1, h / 2);
      if (!is_fault(fault)) fault = check_travel(model, at[k].q);
      if (!is_fault(fault) && piece.kind != PathKind::kJoint)
        fault = check_joins(model, at[k - 1].derivatives(), at[k].derivatives(), h / 2);
      if (is_boxed && !is_fault(fault)) {
        fault = check_boxes(model, piece.tool_length_mm, at[k - 1].derivatives(),
                            at[k].derivatives(), h / 2);
      }
      if (fault.kind != PathFault::Kind::kNone) return fault;
    }
    for (int i = 0; i < count; ++i) {
      cell.d1[i] = bound(at[0].d1[i], at[1].d1[i], at[2].d1[i]);
      cell.d2[i] = bound(at[0].d2[i], at[1].d2[i], at[2].d2[i]);
      cell.d3[i] = bound(at[0].d3[i], at[1].d3[i], at[2].d3[i]);
    }
    double smallest = hardness(model, at[0].d1);
    for (int k = 1; k <= 2; ++k) smallest = std::min(smallest, hardness(model, at[k].d1));
    if (smallest > 0) coarseness_ = std::max(coarseness_, hardness(model, cell.d1) / smallest);
    cell.share_rate = bound(at[0].share_rate, at[1].share_rate, at[2].share_rate);
    cell.noise_rad = axis_noise(model, piece, cell.begin, cell.end);
  }
  joints = at[2].joints;
  return {};
}

JointCell merged(const JointCell& a, const JointCell& b) noexcept {
  JointCell out;
  out.begin = std::min(a.begin, b.begin);
  out.end = std::max(a.end, b.end);
  out.share_rate = std::max(a.share_rate, b.share_rate);
  out.noise_rad = std::max(a.noise_rad, b.noise_rad);
  for (int i = 0; i < kMaxLimited; ++i) {
    out.d1[i] = std::max(a.d1[i], b.d1[i]);
    out.d2[i] = std::max(a.d2[i], b.d2[i]);
    out.d3[i] = std::max(a.d3[i], b.d3[i]);
  }
  return out;
}

}  // namespace meridian
