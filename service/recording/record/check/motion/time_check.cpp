// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/motion/time_check.hpp"

#include <algorithm>
#include <cstdio>

namespace meridian::record {
namespace {

/// Tolerances by which it is not known where on its path the tool is, and the ends.
constexpr double kLag = 10;

}  // namespace

TimeCheck::TimeCheck(const CheckedPath& path, double tolerance_mm, double period_s,
                     const CheckOptions& options)
    : path_(path), tolerance_(tolerance_mm), period_(period_s), factor_(options.max_feed_factor()) {
  entered_.reserve(path.elements().size());
  worst_.kind = Finding::Kind::kBlockTime;
}

void TimeCheck::add(double matched, double passed, std::uint64_t cycle) {
  const auto& elements = path_.elements();
  while (entered_.size() < elements.size() &&
         matched >= elements[entered_.size()].path_begin + tolerance_) {
    entered_.push_back(cycle);
  }
  for (; left_ < entered_.size(); ++left_) {
    const PathElement& element = elements[left_];
    if (passed < element.path_begin + element.path_length - tolerance_) return;
    passed_ += element.path_length;
    if (!element.is_block_end) continue;
    check(element, entered_[first_], cycle);
    first_ = left_ + 1;
    passed_ = 0;
  }
}

void TimeCheck::check(const PathElement& last, std::uint64_t begin, std::uint64_t end) {
  const double path_begin = passed_ - kLag * tolerance_;
  if (!last.is_timed || !(path_begin > 0)) return;
  const double min = path_begin / (last.path_mm_per_s * factor_);
  const double share = static_cast<double>(end - begin + 1) * period_ / min;
  if (share >= 1 - kRoundingShare) return;
  ++worst_.count;
  if (share >= worst_share_) return;
  worst_share_ = share;
  worst_.cycle = end;
  worst_.line = last.line;
  char text[128];
  std::snprintf(text, sizeof text, "a block takes %.6f of its inverse time", share);
  worst_.text = text;
}

void TimeCheck::finish(CheckReport& report) const {
  if (worst_.count > 0) report.findings.push_back(worst_);
}

}  // namespace meridian::record
