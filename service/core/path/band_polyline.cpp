// SPDX-License-Identifier: Apache-2.0
#include "service/core/path/band_polyline.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"

namespace meridian {
namespace {

/// Share of the tip tolerance that chords of an arc may use.
constexpr double kChordShare = 0.02;
/// Share of the tolerances that is kept for points dropped (kMinStep_mm), for the chord of the
/// axis instead of its arc and for the parameter of the two (docs/motion.md, 1.1).
constexpr double kReserve = 0.002;
/// Within this angle of the pole the band has kBesidePoleShare of the axis tolerance.
constexpr double kPoleReach_rad = 0.02;
constexpr double kLargestTurn_rad = 0.052;  // 3 deg

Vector6 join(const ToolPose& pose) noexcept {
  return {pose.tip[0], pose.tip[1], pose.tip[2], pose.axis[0], pose.axis[1], pose.axis[2]};
}

Vector3 tip_of(const Vector6& x) noexcept { return {x[0], x[1], x[2]}; }
Vector3 axis_of(const Vector6& x) noexcept { return {x[3], x[4], x[5]}; }

/// Whether some point of the chord from `a` to `b` lies within kPoleReach_rad of `pole` or its
/// opposite.
bool comes_near(const Vector3& pole, const Vector3& a, const Vector3& b) noexcept {
  const Vector3 from = a.cross(pole), chord = b.cross(pole) - from;
  const double square = chord.squaredNorm();
  const double t = square > 0 ? std::clamp(-from.dot(chord) / square, 0.0, 1.0) : 0.0;
  return (from + t * chord).squaredNorm() < kPoleReach_rad * kPoleReach_rad;
}

}  // namespace

BandPolyline::BandPolyline() : ring_(static_cast<std::size_t>(kVertexCapacity)) {}

/// Index of the first vertex from `low` on that `is_it`, as all behind it; steps that double, since
/// what is looked for is mostly near.
template <class Is>
std::int64_t BandPolyline::find_first(std::int64_t low, Is is_it) const noexcept {
  std::int64_t high = last() + 1;
  for (std::int64_t step = 1; low + step <= high; step *= 2) {
    if (is_it(ring_[low + step - 1])) {
      high = low + step - 1;
    } else {
      low += step;
    }
  }
  while (low < high) {
    const std::int64_t middle = (low + high) / 2;
    if (is_it(ring_[middle])) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

void BandPolyline::begin(const ToolPose& pose, const BandTolerance& tolerance) noexcept {
  ring_.clear();
  tolerance_ = tolerance;
  // Tip and axis share u; on a chord the axis turns by 0.008 Δ³ unevenly: at most 0.1 %.
  largest_turn_ = std::min(kLargestTurn_rad, std::cbrt(0.125 * tolerance.axis_rad));
  is_finished_ = false;
  piece_.reset();
  pose_ = pose;
  pattern_ = BandVertex{};
  BandVertex first;
  first.x = join(pose);
  ring_.push(first);
}

double BandPolyline::share_of(const BandVertex& vertex) noexcept {
  return vertex.is_of_arc ? 1 - kReserve - kChordShare : 1 - kReserve;
}

void BandPolyline::take(const ClBlock& block) noexcept {
  end_ = {to_vector(block.tip_mm), to_vector(block.axis)};
  piece_ = block.is_arc ? make_arc(pose_, end_, block) : make_line(pose_, end_);
  double steps = std::ceil(piece_->axis_turn / largest_turn_);
  pattern_.is_of_arc = block.is_arc;
  if (block.is_arc) {
    const double radius = to_vector(piece_->arc_x).norm();
    const double sagitta = kChordShare * tolerance_.tip_mm;
    const double sweep = 4 * std::asin(std::sqrt(std::min(0.5, 0.5 * sagitta / radius)));
    steps = std::max(steps, std::ceil(piece_->arc_sweep / sweep));
  }
  steps_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(steps));
  step_ = 0;
  take_feed(block);
  pattern_.sequence = block.sequence;
  pattern_.line = block.line;
  cut();
}

/// What tip and axis hardly do counts as a tolerance over the reach: the smooth path needs that.
void BandPolyline::take_feed(const ClBlock& block) noexcept {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const bool is_inverse = block.feed_meaning == FeedMeaning::kInverseTime;
  const double tip = tip_length(*piece_), reaches = piece_->length / kSpeedReach_mm;
  const double turn = std::max(piece_->axis_turn, tolerance_.axis_rad * reaches);
  const double per_s = is_inverse ? block.feed : block.feed / tip;
  pattern_.feed_mm_per_s = is_inverse ? kInfinite : block.feed;
  pattern_.u_speed_mm_per_s = is_inverse ? block.feed * piece_->length : kInfinite;
  pattern_.is_short_in_time =
      is_inverse &&
      piece_->length < tolerance_.tip_mm + kAxisLength_mm_per_rad * tolerance_.axis_rad;
  pattern_.block_feed_mm_per_s = is_inverse ? block.feed * tip : block.feed;
  pattern_.asked_mm_per_s =
      is_inverse ? block.feed * std::max(tip, tolerance_.tip_mm * reaches) : block.feed;
  pattern_.asked_rad_per_s = turn > 0 ? per_s * turn : 0;
}

bool BandPolyline::cut() noexcept {
  while (piece_ && !ring_.is_full()) {
    if (++step_ < steps_) {
      const double share = static_cast<double>(step_) / static_cast<double>(steps_);
      add(pose_at(*piece_, share * piece_->length), false);
    } else {
      add(end_, true);
      pose_ = end_;
      piece_.reset();
    }
  }
  return !piece_;
}

void BandPolyline::add(const ToolPose& pose, bool ends_block) noexcept {
  BandVertex& before = ring_.back();
  BandVertex next = pattern_;
  next.x = join(pose);
  const Vector3 tip = tip_of(next.x) - tip_of(before.x);
  const Vector3 axis = axis_of(next.x) - axis_of(before.x);
  const double square =
      tip.squaredNorm() + kAxisLength_mm_per_rad * kAxisLength_mm_per_rad * axis.squaredNorm();
  if (square < kMinStep_mm * kMinStep_mm) {
    if (ends_block && before.sequence == next.sequence) before.ends_block = true;
    return;
  }
  next.u = before.u + std::sqrt(square);
  next.ends_block = ends_block;
  next.side = find_side(before.x, next.x);
  next.beside_pole = before.beside_pole;
  next.on_pole = before.on_pole;
  if (next.side == PoleSide::kBeside) ++next.beside_pole;
  if (next.side == PoleSide::kOn) ++next.on_pole;
  next.tip_turns = before.tip_turns;
  next.axis_turns = before.axis_turns;
  if (last() > 0) {
    const BandVertex& earlier = ring_[last() - 1];
    const double back = before.u - earlier.u, forth = next.u - before.u;
    next.tip_turns += (tip / forth - (tip_of(before.x) - tip_of(earlier.x)) / back).norm();
    next.axis_turns += (axis / forth - (axis_of(before.x) - axis_of(earlier.x)) / back).norm();
  }
  ring_.push(next);
}

PoleSide BandPolyline::find_side(const Vector6& from, const Vector6& to) const noexcept {
  if (!tolerance_.pole) return PoleSide::kFar;
  const Vector3 pole = to_vector(*tolerance_.pole);
  if (!comes_near(pole, axis_of(from), axis_of(to))) return PoleSide::kFar;
  const double on_pole = kOnPole_tolerances * tolerance_.axis_rad;
  const double off = std::max(axis_of(from).cross(pole).norm(), axis_of(to).cross(pole).norm());
  return off < on_pole ? PoleSide::kOn : PoleSide::kBeside;
}

double BandPolyline::axis_share_of(PoleSide side) noexcept {
  switch (side) {
    case PoleSide::kBeside:
      return kBesidePoleShare;
    case PoleSide::kOn:
      return kOnPoleShare;
    case PoleSide::kFar:
      break;
  }
  return 1;
}

double BandPolyline::axis_tolerance_between(const BandVertex& before,
                                            const BandVertex& to) const noexcept {
  static_assert(2 * kVertexReach + 1 < 1 << 13, "the counts of BandVertex come round");
  PoleSide side = PoleSide::kFar;
  if (to.on_pole != before.on_pole) side = PoleSide::kOn;
  if (to.beside_pole != before.beside_pole) side = PoleSide::kBeside;
  return axis_share_of(side) * tolerance_.axis_rad;
}

std::int64_t BandPolyline::find_after(double u, std::int64_t low) const noexcept {
  return find_first(low, [u](const BandVertex& vertex) { return vertex.u > u; });
}

std::int64_t BandPolyline::find_from(double u, std::int64_t low) const noexcept {
  return find_first(low, [u](const BandVertex& vertex) { return vertex.u >= u; });
}

std::int64_t BandPolyline::segment_at(double u, std::int64_t low) const noexcept {
  return std::clamp(find_after(u, low + 1), low + 1, last()) - 1;
}

Vector6 BandPolyline::at(double u, std::int64_t i) const noexcept {
  const BandVertex& a = ring_[i];
  const BandVertex& b = ring_[i + 1];
  const double share = (u - a.u) / (b.u - a.u);
  Vector6 out;
  for (std::size_t d = 0; d < 6; ++d) out[d] = a.x[d] + share * (b.x[d] - a.x[d]);
  return out;
}

}  // namespace meridian
