// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/certify/join_check.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/kinematics/winding.hpp"

namespace meridian::certify {
namespace {

/// Largest difference of two sets, of whole turns aside where they do not count.
[[nodiscard]] double gap(const Interval& a, const Interval& b, bool in_turns) {
  Interval by = b - a;
  if (in_turns) {
    const double turns = whole_turns(by.mid, 0);
    by = by + Interval(turns) * Interval(kTurn_rad, 1e-15);
  }
  return largest(by);
}

}  // namespace

JumpShares JoinCheck::jump_to(const EnclosedMotion& next, bool is_same_path) const {
  JumpShares out{};
  const double t = period_s_;
  for (std::size_t i = 0; i < static_cast<std::size_t>(limited_count(*model_)); ++i) {
    const JointSpec& spec = limited_spec(*model_, static_cast<int>(i));
    const auto by = [&](int order) {
      return gap(end_.q[i].derivative(order), next.q[i].derivative(order),
                 order == 0 && spec.is_rotary && is_same_path);
    };
    const double dq = by(0) / t, dv = by(1), da = by(2);
    out[i] = {dq / spec.limits.velocity, (dq + dv) / t / spec.limits.acceleration,
              (2 * dq / t + dv / t + 0.75 * da) / t / spec.limits.jerk};
  }
  return out;
}

JoinCheck::Verdict JoinCheck::check(
    const JumpShares& jump, const std::array<std::array<double, 3>, kMaxLimited>& next_bound) {
  Verdict verdict;
  recent_.push_back({time_s_, jump});
  const double from = time_s_ - 3 * period_s_;
  std::erase_if(recent_, [from](const Jump& old) { return old.time_s < from; });
  for (std::size_t i = 0; i < static_cast<std::size_t>(limited_count(*model_)); ++i) {
    for (std::size_t order = 0; order < 3; ++order) {
      double sum = 0;
      for (const Jump& one : recent_) sum += one.shares[i][order];
      const Share share{sum, static_cast<Quantity>(order), static_cast<int>(i), 0};
      if (!(sum <= verdict.worst[order].share)) verdict.worst[order] = share;
      const double together = sum + std::max(bound_[i][order], next_bound[i][order]);
      if (sum <= kRoundingShare || together <= 1) continue;
      verdict.is_joined = false;
      if (!(sum <= verdict.broken.share)) verdict.broken = share;
    }
  }
  return verdict;
}

JoinCheck::Verdict JoinCheck::go_on(const PieceVerdict& piece, double duration, bool is_same_path) {
  Verdict verdict;
  if (is_known_) verdict = check(jump_to(piece.begin, is_same_path), piece.joint_bound);
  is_known_ = true;
  time_s_ += duration;
  end_ = piece.end;
  bound_ = piece.joint_bound;
  return verdict;
}

JoinCheck::Verdict JoinCheck::rest() {
  if (!is_known_) return {};
  EnclosedMotion still;
  for (std::size_t i = 0; i < kMaxLimited; ++i) still.q[i].set(0, end_.q[i][0].mid);
  const Verdict verdict = check(jump_to(still, false), {});
  end_ = still;
  bound_ = {};
  return verdict;
}

}  // namespace meridian::certify
