// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_probes.hpp"

#include <algorithm>

#include "meridian/path/pose_at.hpp"

namespace meridian {

void PoleProbes::begin(bool is_probing) noexcept {
  spans_.clear();
  is_probing_ = is_probing;
}

void PoleProbes::push(const BandSpan& span) noexcept {
  Probed probed;
  probed.band = span;
  for (int k = 0; is_probing_ && k < kProbes; ++k) {
    const ToolPose pose = pose_on(span.c, span.length * k / kProbes);
    probed.distance[static_cast<std::size_t>(k)] = pole_distance(model_, pose.axis);
  }
  spans_.push(probed);
}

double PoleProbes::front_distance() const noexcept {
  const auto& distance = spans_[spans_.begin_index()].distance;
  return *std::min_element(distance.begin(), distance.end());
}

double PoleProbes::end_u() const noexcept {
  return spans_.back().band.u0 + spans_.back().band.length;
}

const BandSpan& PoleProbes::span_at(double u) const noexcept {
  std::int64_t low = spans_.begin_index(), high = spans_.end_index();
  while (high - low > 1) {
    const std::int64_t middle = (low + high) / 2;
    (spans_[middle].band.u0 <= u ? low : high) = middle;
  }
  return spans_[low].band;
}

double PoleProbes::u_of(ProbeIndex probe) const noexcept {
  const BandSpan& span = spans_[probe / kProbes].band;
  return span.u0 + span.length * static_cast<double>(probe % kProbes) / kProbes;
}

double PoleProbes::distance_of(ProbeIndex probe) const noexcept {
  return spans_[probe / kProbes].distance[static_cast<std::size_t>(probe % kProbes)];
}

double PoleProbes::distance_at(double u) const noexcept {
  const BandSpan& span = span_at(u);
  return pole_distance(model_, pose_on(span.c, std::clamp(u - span.u0, 0.0, span.length)).axis);
}

double PoleProbes::find_nearest(ProbeIndex probe) const noexcept {
  double a = probe > begin_probe() ? u_of(probe - 1) : u_of(probe);
  double b = probe + 1 < end_probe() ? u_of(probe + 1) : end_u();
  for (int n = 0; n < 60; ++n) {
    const double x = a + 0.382 * (b - a), y = a + 0.618 * (b - a);
    if (distance_at(x) < distance_at(y)) {
      b = y;
    } else {
      a = x;
    }
  }
  return 0.5 * (a + b);
}

}  // namespace meridian
