// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace meridian::surface {

/// Longest step from `at` towards `end` whose error stays inside `bound`, found from `guess` on for
/// an error that grows about as the square of the step. `error_of(from, to)` gives an optional
/// error. None where it gives none, or where the step would have to be shorter than `min`.
template <class ErrorOf>
[[nodiscard]] std::optional<double> longest_step(double at, double end, double guess, double min,
                                                 double bound, const ErrorOf& error_of) {
  constexpr int kTries = 60;
  constexpr double kUseful = 1.03;  // what a longer step must gain
  double step = std::min(guess, end - at), good = 0;
  for (int i = 0; i < kTries && (i == 0 || step > min); ++i) {
    const std::optional<double> error = error_of(at, at + step);
    if (!error) return std::nullopt;
    const double factor = 0.97 * std::sqrt(bound / std::max(*error, 1e-6 * bound));
    if (*error > bound) {
      if (good > 0) return good;
      step *= std::clamp(factor, 0.1, 0.9);
      continue;
    }
    good = step;
    const double longer = std::min(step * std::min(factor, 4.0), end - at);
    if (longer < kUseful * step) return good;
    step = longer;
  }
  if (good > 0) return good;
  return std::nullopt;
}

/// Places from `begin` to `end`, both included, every step inside `bound`; the last two steps are
/// of one length, so that no tiny one is left over. Appends to `places`, which already ends in
/// `begin`; false where that takes more than `max` places.
template <class ErrorOf>
[[nodiscard]] bool append_steps(std::vector<double>& parameters, double end, double bound,
                                std::size_t max, const ErrorOf& error_of) {
  const double span = end - parameters.back();
  const double min = span / static_cast<double>(max);
  double guess = span;
  while (parameters.back() < end) {
    const double at = parameters.back();
    const auto step = longest_step(at, end, guess, min, bound, error_of);
    if (!step || parameters.size() >= max) return false;
    guess = *step;
    const double rest = end - at - *step;
    if (rest <= 1e-12 * span) {
      parameters.push_back(end);
    } else if (rest < *step) {
      const double middle = at + 0.5 * (end - at);
      const auto second = error_of(middle, end);
      if (!second) return false;
      parameters.push_back(*second <= bound ? middle : at + *step);
    } else {
      parameters.push_back(at + *step);
    }
  }
  return true;
}

}  // namespace meridian::surface
