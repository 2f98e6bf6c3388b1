// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_corridor.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/path/pose_at.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/singular/pole/pole_bounds.hpp"

namespace meridian {
namespace {

constexpr double kCutGrowth = 1.5, kFarthestCut_mm = 5, kFirstCut = 0.25;
constexpr double kMinPart_mm = 1e-6;
constexpr int kShorter = 6;  // stretches that are tried where the whole one has no route
constexpr double kShorterShare = 0.4;
/// Spans farther off than this (11.5 deg) are not held back. u advances by at least 50 mm per rad
/// of axis, so a zone beside them still has half of its reach.
constexpr double kOutOfReach_rad = 0.5 * kPoleReach_mm / kAxisLength_mm_per_rad;

/// By which the redundant joint goes at the end of a piece.
double held_rate_of(const PoleZone& piece) noexcept {
  return 5 * (piece.free[5] - piece.free[4]) / (piece.end - piece.begin);
}

}  // namespace

PoleCorridor::PoleCorridor(const MachineModel& model, PoleLookAhead* look_ahead)
    : model_(model),
      look_ahead_(look_ahead),
      probes_(model),
      stretches_(probes_),
      pending_(kPending) {}

void PoleCorridor::begin(const Start& start) noexcept {
  has_pole_ = redundant_joint(model_) >= 0 && !start.is_on_pole;
  tool_length_mm_ = start.tool_length_mm;
  is_exact_ = model_.pole_policy == PolePolicy::kExact;
  tolerance_rad_ =
      is_exact_ ? kPoleDeviation_rad : std::max(start.tolerance_rad, kPoleDeviation_rad);
  programmed_.begin(start.axis);
  probes_.begin(has_pole_);
  stretches_.begin(tolerance_rad_);
  emitted_x_ = known_u_ = 0;
  known_ = start.joints;
  course_ = out_course_ = {start.branch, false, 0};
  pending_.clear();
  cut_count_ = 0;
  is_finished_ = false;
  search_ = Search::kGoesOn;
  asked_u_ = -1;
}

void PoleCorridor::add_cut(double u) noexcept {
  if (cut_count_ == kCuts || u <= emitted_u()) return;
  const auto end = cuts_.begin() + static_cast<std::ptrdiff_t>(cut_count_++);
  *end = u;
  std::rotate(std::upper_bound(cuts_.begin(), end, u), end, end + 1);
}

void PoleCorridor::add_cuts(double nearest) noexcept {
  // The redundant joint turns over a width of distance/|d axis/du|.
  const BandSpan& span = probes_.span_at(nearest);
  const auto pose =
      pose_on(span.c, Jet<1>::variable(std::clamp(nearest - span.u0, 0.0, span.length)));
  double rate = 0;
  for (int i = 0; i < 3; ++i) rate += pose.axis[i].derivative(1) * pose.axis[i].derivative(1);
  const double width = probes_.distance_at(nearest) / std::max(std::sqrt(rate), 1e-9);
  add_cut(nearest);
  double off = kFirstCut * std::max(width, 1e-5);
  for (int n = 0; n < 28 && off < kFarthestCut_mm; ++n, off *= kCutGrowth) {
    add_cut(nearest - off);
    add_cut(nearest + off);
  }
}

JointVector PoleCorridor::follow_to(double u) const noexcept {
  const int free = redundant_joint(model_);
  JointVector joints = known_;
  double at = known_u_, step = 0;
  while (at < u) {
    const BandSpan& span = probes_.span_at(at);
    const double whole = std::max(span.length / PoleProbes::kProbes, kMinPart_mm);
    step = std::min(step > 0 ? 2 * step : whole, whole);
    for (;; step *= 0.5) {  // so short that a turn of the redundant joint is seen
      const double next = std::min(u, at + step);
      const BandSpan& there = probes_.span_at(next);
      const auto pose = pose_on(there.c, std::clamp(next - there.u0, 0.0, there.length));
      const auto solved = solve(model_, tool_length_mm_, pose, course_.branch, joints);
      const bool is_there = solved.status != SolveStatus::kUnreachable;
      const bool is_turn =
          is_there && free >= 0 && std::abs(solved.q[free] - joints[free]) > kMaxFollowed_rad;
      if (is_turn && step > kMinFollowed_mm) continue;
      if (is_there) joints = solved.q;
      at = next;
      break;
    }
  }
  return joints;
}

SettledPath PoleCorridor::settled() const noexcept {
  const bool has_zone = pending_.begin_index() != pending_.end_index();
  SettledPath out;
  out.end = has_zone ? std::max(emitted_u(), pending_.back().end) : emitted_u();
  out.is_begun = pending_.end_index() > 0 || emitted_u() > 0;
  out.is_held = course_.is_held;
  out.is_whole = is_finished_;
  out.branch = course_.branch;
  return out;
}

void PoleCorridor::scan() noexcept {
  if (search_ == Search::kNeedsAhead) search_ = Search::kGoesOn;
  if (probes_.is_empty()) return;
  while (!has_failed() && stretches_.find_next(settled())) {
    // Not before a span waits for it: searches are dear, and so no two come at once.
    if (may_emit() && !probes_.is_full()) return;
    PoleStretch stretch;
    const PoleProbes::ProbeIndex before = stretches_.probe();
    const PoleStretches::Answer answer = stretches_.decide(stretch);
    if (answer == PoleStretches::Answer::kNeedsSpans) return;
    if (answer != PoleStretches::Answer::kFound) continue;
    if (stretch.has_room && !foresee(stretch.pass)) {
      stretches_.go_back_to(before);
      search_ = Search::kNeedsAhead;
      return;
    }
    settle(stretch);
  }
}

void PoleCorridor::lead_to(PolePass& pass) const noexcept {
  pass.joints = pass.at_begin == PoleJoin::kExact ? follow_to(pass.begin) : known_;
}

std::span<const PoleZone> PoleCorridor::find_string(PoleStretch& stretch) noexcept {
  const PoleTask task{model_, probes_, programmed_, tool_length_mm_, tolerance_rad_, is_exact_};
  PolePass& pass = stretch.pass;
  auto pieces = string_.find(task, pass);
  if (!pieces.empty()) return pieces;
  const bool is_rest_on_pole =
      pass.at_end == PoleJoin::kRest && probes_.distance_at(pass.end) < kPoleDeviation_rad;
  const PoleStretch whole = stretch;
  if (is_rest_on_pole && pass.exact == ExactPath::kLeadsOn) pass.exact = ExactPath::kEndsOnPole;
  const bool ends_on_pole = pass.exact == ExactPath::kEndsOnPole;
  const auto try_shorter = [&](double reach_mm) {
    if (!stretches_.shorten(stretch, reach_mm)) return;
    lead_to(pass);
    pieces = string_.find(task, pass);
  };
  const auto is_found = [&] {
    const bool is_exact = !ends_on_pole && (string_.is_exact_best() || may_be_exact(pass));
    return !pieces.empty() || is_exact;
  };
  double reach = kPoleReach_mm;
  for (int n = 0; n < kShorter && !is_found(); ++n) {
    reach *= kShorterShare;
    try_shorter(reach);
  }
  while (!is_found() && ends_on_pole && stretches_.narrow_onto_end(stretch)) try_shorter(0);
  if (pieces.empty() && ends_on_pole) stretch = whole;
  return pieces;
}

void PoleCorridor::settle(PoleStretch& stretch) noexcept {
  PolePass& pass = stretch.pass;
  lead_to(pass);
  pass.rate = course_.rate;
  pass.exact = is_on_pole(stretch) ? ExactPath::kMeetsPole : ExactPath::kLeadsOn;
  const auto waiting = static_cast<std::size_t>(pending_.end_index() - pending_.begin_index());
  bool is_exact_best = false;
  if (stretch.has_room && waiting + FreeSpline::kPieces <= kPending) {
    const auto pieces = find_string(stretch);
    for (const PoleZone& piece : pieces) pending_.push(piece);
    if (!pieces.empty()) return know_after(pieces.back());
    is_exact_best = string_.is_exact_best();
  }
  if (!is_exact_best && !may_be_exact(pass)) {
    search_ = Search::kFailed;
    return;
  }
  for (PoleProbes::ProbeIndex n = stretch.first; n <= stretch.last; ++n) {
    if (stretches_.is_minimum(n)) add_cuts(probes_.find_nearest(n));
  }
}

/// Whether the exact path leads along the stretch from where the redundant joint is at its begin.
bool PoleCorridor::may_be_exact(const PolePass& pass) const noexcept {
  if (pass.exact == ExactPath::kMeetsPole || pass.at_begin == PoleJoin::kHeld) return false;
  return pass.at_begin == PoleJoin::kExact || probes_.distance_at(pass.begin) >= tolerance_rad_;
}

/// Whether the path meets the pole on the stretch.
bool PoleCorridor::is_on_pole(const PoleStretch& stretch) const noexcept {
  if (probes_.distance_at(stretch.nearest) < kPoleDeviation_rad) return true;
  for (PoleProbes::ProbeIndex n = stretch.first; n <= stretch.last; ++n) {
    if (probes_.distance_of(n) < kPoleDeviation_rad) return true;
    const bool is_passed = stretches_.is_minimum(n) &&
                           probes_.distance_at(probes_.find_nearest(n)) < kPoleDeviation_rad;
    if (is_passed) return true;
  }
  return false;
}

void PoleCorridor::know_after(const PoleZone& piece) noexcept {
  course_ = {piece.branch_after, piece.is_held, held_rate_of(piece)};
  known_u_ = piece.end;
  JointVector reference{};
  if (const int free = redundant_joint(model_); free >= 0) reference[free] = piece.free.back();
  const BandSpan& span = probes_.span_at(piece.end);
  const auto pose = pose_on(span.c, std::clamp(piece.end - span.u0, 0.0, span.length));
  known_ = course_.is_held ? solve_held(model_, tool_length_mm_, pose, piece.free.back()).q
                           : solve(model_, tool_length_mm_, pose, course_.branch, reference).q;
}

bool PoleCorridor::is_in_zone() const noexcept {
  if (pending_.begin_index() == pending_.end_index()) return false;
  const PoleZone& piece = pending_[pending_.begin_index()];
  return !piece.is_first || piece.begin < emitted_u() - kMinPart_mm;
}

bool PoleCorridor::fits_zone(double by) const noexcept {
  constexpr int kSamples = 8;
  if (!is_in_zone()) return true;
  for (std::int64_t i = pending_.begin_index(); i < pending_.end_index(); ++i) {
    const PoleZone& piece = pending_[i];
    const double begin = std::max(piece.begin, emitted_u());
    for (int n = 0; n <= kSamples; ++n) {
      const double u = begin + n * (piece.end - begin) / kSamples;
      const BandSpan& span = probes_.span_at(u);
      const double free =
          quintic_at(piece.free, (u - piece.begin) / (piece.end - piece.begin)) + by;
      const ToolPose pose = pose_on(span.c, std::clamp(u - span.u0, 0.0, span.length));
      const auto at = solve_held(model_, tool_length_mm_, pose, free);
      if (first_joint_outside_travel(model_, at.q, kTravelMargin) >= 0) return false;
    }
    if (piece.is_last) return true;
  }
  return true;
}

void PoleCorridor::wind(double by, const JointVector& joints) noexcept {
  if (redundant_joint(model_) < 0) return;
  std::int64_t kept = pending_.begin_index();  // the rest of the stretch that it lies in
  for (bool is_in = is_in_zone(); is_in && kept < pending_.end_index(); ++kept) {
    PoleZone& piece = pending_[kept];
    for (double& value : piece.free) value += by;
    is_in = !piece.is_last;
  }
  while (pending_.end_index() > kept) pending_.drop_last();
  cut_count_ = 0;
  asked_u_ = -1;
  stretches_.begin_again();
  if (kept > pending_.begin_index()) return know_after(pending_.back());
  course_ = out_course_;
  known_ = joints;
  if (!probes_.is_empty()) known_u_ = emitted_u();
}

bool PoleCorridor::may_emit() const noexcept {
  if (!has_pole_) return true;
  const PoleProbes::ProbeIndex last = probes_.end_probe() - 1, probe = stretches_.probe();
  if (is_finished_ && probe > last) return true;
  const BandSpan& front = probes_.front();
  const double end = front.u0 + front.length, checked = probes_.u_of(std::min(probe, last));
  if (end > checked) return false;
  const bool is_out_of_reach =
      probes_.front_distance() > kOutOfReach_rad + front.length / kAxisLength_mm_per_rad;
  return is_out_of_reach || probes_.is_full() || end <= checked - kPoleReach_mm;
}

void PoleCorridor::emit() noexcept {
  const BandSpan& span = probes_.front();
  const double begin = span.u0 + emitted_x_, last = span.u0 + span.length;
  double end = last;
  const auto cut_at = [&](double u) {
    if (u > begin && u < end) end = u;
  };
  const bool has_zone = pending_.begin_index() != pending_.end_index();
  const PoleZone zone = has_zone ? pending_[pending_.begin_index()] : PoleZone{};
  if (has_zone) {
    cut_at(zone.begin);
    cut_at(zone.end);
  }
  std::size_t passed = 0;
  while (passed < cut_count_ && cuts_[passed] < begin + kMinPart_mm) ++passed;
  std::move(cuts_.begin() + static_cast<std::ptrdiff_t>(passed),
            cuts_.begin() + static_cast<std::ptrdiff_t>(cut_count_), cuts_.begin());
  cut_count_ -= passed;
  if (cut_count_ > 0 && cuts_[0] < end - kMinPart_mm) cut_at(cuts_[0]);

  const bool is_rest = end == last;
  const double length = is_rest ? span.length - emitted_x_ : end - begin;
  const bool is_whole = is_rest && emitted_x_ == 0;
  out_ = {};
  out_.band = is_whole ? span : part_of_span(span, emitted_x_, length);
  out_.branch = out_course_.branch;
  const double middle = begin + 0.5 * length;
  if (has_zone && middle > zone.begin && middle < zone.end) {
    const double h = zone.end - zone.begin;
    out_.is_free_driven = true;
    out_.free = part_of(zone.free, begin <= zone.begin ? 0 : (begin - zone.begin) / h,
                        end >= zone.end ? 1 : (end - zone.begin) / h);
    out_.axis_deviation_rad = zone.deviation_rad;
    out_.reason = zone.is_through                           ? RelaxedReason::kThrough
                  : zone.deviation_rad < kPoleDeviation_rad ? RelaxedReason::kOnPole
                                                            : RelaxedReason::kBeside;
  }
  if (has_zone && end >= zone.end) {
    out_course_ = {zone.branch_after, zone.is_held, held_rate_of(zone)};
    pending_.drop_before(pending_.begin_index() + 1);
  }
  if (has_pole_ && end > known_u_) {
    known_ = follow_to(end);
    known_u_ = end;
  }
  emitted_x_ += length;
  if (is_rest) {
    emitted_x_ = 0;
    probes_.drop_front();
  }
}

const JointSpan* PoleCorridor::next() noexcept {
  if (has_pole_) scan();
  if (search_ != Search::kGoesOn || probes_.is_empty() || !may_emit()) return nullptr;
  emit();
  return &out_;
}

}  // namespace meridian
