// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/certify/piece_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace meridian::certify {
namespace {

constexpr std::uint64_t kMaxStretches = 3000;
constexpr double kMinShare = 0x1p-40;  // of the piece, that a stretch is halved down to
/// A bound is brought nearer to what is attained until it is that close, but not for ever.
constexpr double kCloseEnough = 5e-4;
constexpr int kSharpenings = 12;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Bound of |f⁽ᵈ⁾| within `reach` of an instant, from the coefficients there and, of order `top`,
/// all about it.
[[nodiscard]] double bound_of(const Enclosure& centre, const Enclosure& all, int d, int top,
                              double reach) {
  Interval sum;
  Interval power = 1;
  for (int i = d; i <= top; ++i) {
    double factor = 1;
    for (int n = i - d + 1; n <= i; ++n) factor *= n;
    const Interval term = (i == top ? all[i] : centre[i]) * Interval(factor);
    if (i == d) {
      sum = term;
    } else if ((i - d) % 2 == 1) {
      sum = sum + Interval(0, largest(term) * upper(power));
    } else {
      sum = sum + term * Interval(0.5, 0.5) * power;  // an even power is of one sign
    }
    power = power * Interval(reach);
  }
  return largest(sum);
}

[[nodiscard]] double limit_of(const JointLimits& limits, std::size_t order) {
  return order == 0 ? limits.velocity : order == 1 ? limits.acceleration : limits.jerk;
}

void raise(Share& share, double value, Quantity quantity, int joint, double time_s) {
  if (value <= share.share) return;
  share = {value, quantity, joint, time_s};
}

}  // namespace

/// What is known of a piece so far.
struct PieceCheck::Trial {
  const PathPiece& path;
  const EnclosedLaw& law;
  double feed = 0;  ///< mm/s; 0: none
  PieceVerdict verdict;
  std::vector<Stretch> open;
  bool is_proved = false, is_close = false;  ///< of the stretch that was looked at last
  std::array<Share, kQuantities> bound;      ///< of that stretch
  std::array<std::array<double, 3>, kMaxLimited> joint_bound{};
};

EnclosedMotion PieceCheck::enclose_at(const PathPiece& path, const EnclosedLaw& law,
                                      const EnclosedState& state, bool has_feed) const {
  const Enclosure s = law.expand<kOrder>(state);
  const bool is_early = s.mid[0] < 0.5 * path.length;
  return enclose(model_, path, s, is_early ? path.joints_begin : path.joints_end, has_feed);
}

void PieceCheck::attain(const EnclosedMotion& at, double time_s, Trial& trial) const {
  if (!at.is_reported) return;
  PieceVerdict& verdict = trial.verdict;
  const auto take = [&](double share, std::size_t quantity, int joint) {
    raise(verdict.attained[quantity], share, static_cast<Quantity>(quantity), joint, time_s);
    if (share > 1 && share > (verdict.status == Status::kRefuted ? verdict.worst.share : 0)) {
      verdict.status = Status::kRefuted;
      verdict.worst = {share, static_cast<Quantity>(quantity), joint, time_s};
    }
  };
  for (int i = 0; i < limited_count(model_); ++i) {
    const JointLimits& limits = limited_spec(model_, i).limits;
    for (std::size_t order = 0; order < 3; ++order) {
      const double size =
          smallest(at.q[static_cast<std::size_t>(i)].derivative(static_cast<int>(order) + 1));
      take(size / limit_of(limits, order), order, i);
    }
  }
  if (trial.feed > 0) take(std::sqrt(smallest(at.tip_square[0])) / trial.feed, 3, -1);
}

void PieceCheck::weigh(const EnclosedMotion& centre, const EnclosedMotion& all, double reach,
                       double time_s, Trial& trial) const {
  trial.bound = {};
  trial.joint_bound = {};
  trial.is_proved = centre.is_reported && all.is_reported;
  trial.is_close = true;
  if (!trial.is_proved) {
    trial.bound[0] = {kUnbounded, Quantity::kVelocity, -1, time_s};
    return;
  }
  const auto take = [&](double any, std::size_t quantity, int joint) {
    const double share = any < kUnbounded ? any : kUnbounded;
    if (!(share <= 1)) trial.is_proved = false;
    const double known = std::max(known_[quantity], trial.verdict.attained[quantity].share);
    if (!(share <= known + kCloseEnough)) trial.is_close = false;
    if (!(share <= trial.bound[quantity].share)) {
      trial.bound[quantity] = {share, static_cast<Quantity>(quantity), joint, time_s};
    }
  };
  for (std::size_t i = 0; i < static_cast<std::size_t>(limited_count(model_)); ++i) {
    const JointLimits& limits = limited_spec(model_, static_cast<int>(i)).limits;
    for (std::size_t order = 0; order < 3; ++order) {
      const double max =
          bound_of(centre.q[i], all.q[i], static_cast<int>(order) + 1, kOrder, reach);
      const double share = max / limit_of(limits, order) * kRaised;
      trial.joint_bound[i][order] = share;
      take(share, order, static_cast<int>(i));
    }
  }
  if (!(trial.feed > 0)) return;
  const double max = bound_of(centre.tip_square, all.tip_square, 0, kOrder - 1, reach);
  take(std::sqrt(max) / trial.feed * kRaised, 3, -1);
}

void PieceCheck::look_at(const Stretch& stretch, Trial& trial) {
  const double middle = 0.5 * (stretch.from + stretch.to);
  const double reach = std::max(stretch.to - middle, middle - stretch.from) * kRaised;
  const EnclosedState state = trial.law.at(middle);
  const bool has_feed = trial.feed > 0;
  const EnclosedMotion centre = enclose_at(trial.path, trial.law, state, has_feed);
  const EnclosedMotion all =
      enclose_at(trial.path, trial.law, trial.law.about(state, reach), has_feed);
  attain(centre, middle, trial);
  weigh(centre, all, reach, middle, trial);
}

/// An instant of the piece is over a limit: the worst of some more.
void PieceCheck::find_peak(const TimePiece& piece, Trial& trial) const {
  constexpr int kInstants = 200;
  for (int n = 0; n <= kInstants; ++n) {
    const double t = piece.duration * n / kInstants;
    attain(enclose_at(trial.path, trial.law, trial.law.at(t), trial.feed > 0), t, trial);
  }
}

PieceVerdict PieceCheck::check(const TimePiece& piece, const PathPiece& path) {
  const EnclosedLaw law(piece);
  Trial trial{path, law, piece.feed_mm_per_s * piece.feed_factor, {}, {}, false, false, {}, {}};
  PieceVerdict& verdict = trial.verdict;
  verdict.begin = enclose_at(path, law, law.at(0), trial.feed > 0);
  verdict.end = enclose_at(path, law, law.at(piece.duration), trial.feed > 0);
  attain(verdict.begin, 0, trial);
  attain(verdict.end, piece.duration, trial);
  trial.open.push_back({0, piece.duration, 0});
  while (!trial.open.empty() && verdict.status != Status::kRefuted) {
    const Stretch stretch = trial.open.back();
    trial.open.pop_back();
    look_at(stretch, trial);
    ++verdict.stretches;
    const double width = stretch.to - stretch.from;
    const bool may_halve = verdict.stretches < kMaxStretches && width > kMinShare * piece.duration;
    const bool is_settled =
        trial.is_proved && (trial.is_close || stretch.depth >= kSharpenings || !may_halve);
    if (!is_settled && may_halve) {
      const double middle = 0.5 * (stretch.from + stretch.to);
      trial.open.push_back({middle, stretch.to, stretch.depth + 1});
      trial.open.push_back({stretch.from, middle, stretch.depth + 1});
      continue;
    }
    if (!trial.is_proved) verdict.status = std::max(verdict.status, Status::kUndecided);
    for (std::size_t n = 0; n < kQuantities; ++n) {
      const Share& share = trial.bound[n];
      if (!(share.share <= verdict.bound[n].share)) verdict.bound[n] = share;
      if (!trial.is_proved && !(share.share <= verdict.worst.share)) verdict.worst = share;
    }
    for (std::size_t i = 0; i < kMaxLimited; ++i) {
      for (std::size_t order = 0; order < 3; ++order) {
        double& max = verdict.joint_bound[i][order];
        if (!(trial.joint_bound[i][order] <= max)) max = trial.joint_bound[i][order];
      }
    }
  }
  if (verdict.status == Status::kRefuted) find_peak(piece, trial);
  for (std::size_t n = 0; n < kQuantities; ++n) {
    known_[n] = std::max(known_[n], verdict.attained[n].share);
  }
  return verdict;
}

}  // namespace meridian::certify
