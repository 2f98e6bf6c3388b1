// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/robot/robot_pass.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "meridian/geometry/segment.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/singular/pole/pole_time.hpp"
#include "service/core/planner/singular/robot/pass_fit.hpp"
#include "service/core/planner/singular/robot/pass_joints.hpp"

namespace meridian {
namespace {

constexpr int kWidths = 18;
constexpr double kNarrower = 0.6;
constexpr int kSamples = 96, kFirstSamples = 12;
constexpr std::size_t kKinks = 192;
constexpr int kRestTurns = 12;  // to each side, of a joint that is to rest elsewhere
constexpr double kRestTurn_rad = std::numbers::pi / kRestTurns;
constexpr double kNever = std::numeric_limits<double>::infinity();

class Search {
 public:
  Search(const PassTask& task, const PassRange& range) noexcept
      : task_(task), range_(range), fit_(task, range_) {
    kink_count_ = task.axes.find_kinks(range.from, range.to, kinks_);
  }

  RobotPass run() noexcept {
    const Best found = search();
    if (is_long(found.pass)) return found.pass;
    if (!is_pass(found.pass)) {
      const Best turned = search_turned();
      if (is_pass(turned.pass)) return turned.pass;
    }
    const Best stopped = search_stopped();
    if (stopped.time < found.time) return stopped.pass;
    if (is_pass(found.pass)) return found.pass;
    wanted_ = Wanted::kAny;  // joints leave travel after it whatever is chosen
    return search().pass;
  }

 private:
  /// What a pass has to be besides inside the tolerance.
  enum class Wanted : std::uint8_t {
    kLeadsOn,  ///< the joints stay in travel after it
    kLong,     ///< that, and no shorter than the tolerance
    kAny
  };
  /// The best so far.
  struct Best {
    double time = kNever;
    RobotPass pass;
  };
  [[nodiscard]] static bool is_pass(const RobotPass& pass) noexcept {
    return pass.end > pass.begin;
  }
  /// In less than the tolerance the joints turn next to standstill.
  [[nodiscard]] bool is_long(const RobotPass& pass) const noexcept {
    return is_pass(pass) && !(pass.end - pass.begin < task_.tip_tolerance_mm);
  }
  /// Where the machine stops inside the tolerance: passes that begin there with the joints as they
  /// stand, and such that also end there with any. None is short.
  [[nodiscard]] Best search_stopped() noexcept {
    const PassRange given = range_;
    wanted_ = Wanted::kLong;
    Best found;
    if (range_.stops_at_from != given.rests_at_from) {
      range_.rests_at_from = range_.rests_at_from | range_.stops_at_from;
      found = search();
    }
    if (!is_pass(found.pass) && range_.stops_at_to != given.rests_at_to) {
      range_.rests_at_to = range_.rests_at_to | range_.stops_at_to;
      range_.rest_share = kStopTolerances;
      found = search();
      if (!is_pass(found.pass)) found = search_turned();
    }
    wanted_ = Wanted::kLeadsOn;
    if (!is_pass(found.pass)) range_ = given;
    return found;
  }
  [[nodiscard]] Best search() noexcept {
    const double widest = std::max(range_.nearest - range_.from, range_.to - range_.nearest);
    double outside = 0, width = widest;
    Best best;
    for (int n = 0; n < kWidths; ++n, width *= kNarrower) {
      if (n > 0) outside += time_beside(width / kNarrower, width);
      if (!(outside < best.time)) break;
      const int over = turned_over(range_.at);
      meets_other_ = false;
      for (const int flip : {over, 0}) consider(width, only(range_.at), flip, outside, best);
      if (!meets_other_ || best.pass.rests_at_end != SingularSet::kNone) continue;
      for (const int flip : {robot::kBack | robot::kFlip, int{robot::kBack}, int{robot::kFlip}, 0})
        consider(width, SingularSet::kWristAndShoulder, flip, outside, best);
    }
    return best;
  }
  /// Beside both singularities rounding turns the roll of the exact path: no more of it than helps.
  [[nodiscard]] static bool is_better(double time, const Best& best) noexcept {
    constexpr double kClearly = 0.999;
    const bool is_of_both = best.pass.at == SingularSet::kWristAndShoulder;
    return time < (is_of_both ? kClearly : 1) * best.time;
  }
  void consider(double width, SingularSet at, int flip, double outside, Best& best) noexcept {
    RobotPass pass = pass_over(width, at);
    pass.branch_after = pass.branch_before ^ flip;
    if (wanted_ == Wanted::kLong && !is_long(pass)) return;
    if (!fit_.fit(pass, 0) || meets_other(pass, kFirstSamples)) return;
    if (!is_inside(pass, kFirstSamples)) return;
    const double time = outside + time_on_pass(task_, pass, fit_.reference(), kSamples / 2);
    if (!is_better(time, best) || meets_other(pass, kSamples)) return;
    if (!is_inside(pass, kSamples) || !is_inside_at_kinks(pass)) return;
    if (wanted_ != Wanted::kAny && !fit_.leads_on(pass)) return;
    best = {time, pass};
  }

  /// Where the joint at rest leads others out of their travel: passes after which it rests at
  /// another value, some of them so short that it turns next to standstill.
  [[nodiscard]] Best search_turned() noexcept {
    constexpr double kShares[] = {1, 0.3, 0.1, 0.03, 0.01};
    Best best;
    if (!contains(range_.rests_at_to, range_.at)) return best;
    for (const double share : kShares) {
      for (int n = 0; n < 2 * kRestTurns; ++n) {
        const double rest_turn = (n % 2 == 0 ? 1 : -1) * kRestTurn_rad * (1 + n / 2);
        RobotPass pass = pass_over(range_.nearest - range_.from, only(range_.at));
        pass.end = range_.nearest + share * (range_.to - range_.nearest);
        if (!fit_.fit(pass, rest_turn) || !is_inside(pass, kFirstSamples)) continue;
        const double time = time_on_pass(task_, pass, fit_.reference(), kSamples / 2);
        if (!(time < best.time) || !is_inside(pass, kSamples) || !is_inside_at_kinks(pass))
          continue;
        if (meets_other(pass, kSamples) || !rests_on(pass)) continue;
        best = {time, pass};
      }
      if (best.pass.end > best.pass.begin) break;
    }
    return best;
  }
  /// Whether the joint may rest behind the pass as far as the range goes.
  [[nodiscard]] bool rests_on(const RobotPass& pass) noexcept {
    if (!(pass.end < range_.to)) return true;
    RobotPass rest = pass;
    rest.begin = pass.end;
    rest.end = range_.to;
    rest.joint.fill(pass.joint.back());
    return is_inside(rest, kSamples);
  }

  [[nodiscard]] bool begins_at_rest(SingularSet at) const noexcept {
    return (range_.rests_at_from & at) != SingularSet::kNone;
  }
  [[nodiscard]] double begin_at(SingularSet at, double width) const noexcept {
    return begins_at_rest(at) ? range_.from
                              : snapped(std::max(range_.from, range_.nearest - width));
  }
  [[nodiscard]] double end_at(SingularSet at, double width) const noexcept {
    // At both, what turns the roll may ask for a shorter one; the yaw may rest anywhere.
    const bool is_long = at != SingularSet::kWristAndShoulder;
    return is_long && (range_.rests_at_to & at) != SingularSet::kNone
               ? range_.to
               : snapped(std::min(range_.to, range_.nearest + width));
  }
  [[nodiscard]] RobotPass pass_over(double width, SingularSet at) const noexcept {
    RobotPass pass;
    pass.at = at;
    pass.begin = begin_at(at, width);
    pass.end = end_at(at, width);
    pass.branch_before = pass.branch_after = range_.branch;
    return pass;
  }
  /// `u`, or the end of a span that is so close that the part between would be none.
  [[nodiscard]] double snapped(double u) const noexcept {
    const BandSpan& span = task_.spans.span_at(u);
    if (std::abs(u - span.u0) < kSamePoint_mm) return span.u0;
    const double end = span.u0 + span.length;
    return std::abs(end - u) < kSamePoint_mm ? end : u;
  }

  /// Of the exact path, where a pass of the width `to` is narrower than one of `from`.
  [[nodiscard]] double time_beside(double from, double to) const noexcept {
    const SingularSet at = only(range_.at);
    return time_exactly(begin_at(at, from), begin_at(at, to)) +
           time_exactly(end_at(at, to), end_at(at, from));
  }
  [[nodiscard]] double time_exactly(double from, double to) const noexcept {
    constexpr int kSteps = 4;
    double sum = 0;
    for (int k = 0; k < kSteps && to > from; ++k) {
      const double u = from + (to - from) * (k + 0.5) / kSteps;
      const BandSpan& span = task_.spans.span_at(u);
      const auto pose = pose_of<Jet<3>>(span, u);
      const auto at = solve(task_.model, task_.tool_length_mm, pose, range_.branch, range_.joints);
      if (at.status == SolveStatus::kUnreachable) return kNever;
      sum += (to - from) / kSteps * slowness(task_.model, span, pose, at.q);
    }
    return sum;
  }

  /// Whether `q` is inside travel and the tool inside its tolerance at `u`.
  bool is_within(RobotPass& pass, double u, const Solution<double>& at) const noexcept {
    if (at.status == SolveStatus::kUnreachable) return false;
    if (first_joint_outside_travel(task_.model, at.q, kTravelMargin) >= 0) return false;
    if (!settles(task_, pass, at.q)) return false;
    const PassDeviation off = deviation_on_pass(task_, pass, u, at.q);
    pass.axis_deviation_rad = std::max(pass.axis_deviation_rad, off.axis_rad);
    const bool rests = pass.rests_at_end != SingularSet::kNone && !(u < pass.end);
    const double share = rests ? kStopTolerances : kSampledShare;  // what follows begins there
    return off.axis_rad <= share * task_.axis_tolerance_rad &&
           off.tip_mm <= share * task_.tip_tolerance_mm;
  }
  bool is_inside(RobotPass& pass, int samples) const noexcept {
    for (int k = 0; k <= samples; ++k) {
      const double u = pass.begin + (pass.end - pass.begin) * k / samples;
      if (!is_within(pass, u, joints_on_pass(task_, pass, u, fit_.reference()))) return false;
    }
    return true;
  }
  /// Whether a pass at one singularity meets the other one, inside its tolerance or not.
  bool meets_other(const RobotPass& pass, int samples) noexcept {
    const double met = other_tolerance(task_, pass);
    if (!(met > 0)) return false;
    Vector3 before;
    for (int k = 0; k <= samples; ++k) {
      const double u = pass.begin + (pass.end - pass.begin) * k / samples;
      const JointVector q = joints_on_pass(task_, pass, u, fit_.reference()).q;
      const Vector3 off = off_other_singularity(task_, pass, u, q);
      if (distance_to_segment(Vector3::Zero(), k > 0 ? before : off, off) < met) {
        meets_other_ = true;
        return true;
      }
      before = off;
    }
    return false;
  }
  /// The same where the programmed axis turns sharply.
  bool is_inside_at_kinks(RobotPass& pass) const noexcept {
    for (std::size_t n = 0; n < kink_count_; ++n) {
      const bool is_there = kinks_[n] > pass.begin && kinks_[n] < pass.end;
      if (!is_there) continue;
      if (!is_within(pass, kinks_[n], joints_on_pass(task_, pass, kinks_[n], fit_.reference())))
        return false;
    }
    return true;
  }

  const PassTask& task_;
  PassRange range_;
  PassFit fit_;
  std::array<double, kKinks> kinks_{};  // u
  std::size_t kink_count_ = 0;
  Wanted wanted_ = Wanted::kLeadsOn;
  bool meets_other_ = false;  // a pass at one singularity, where it was looked for last
};

}  // namespace

RobotPass find_robot_pass(const PassTask& task, const PassRange& range) noexcept {
  return Search(task, range).run();
}

}  // namespace meridian
