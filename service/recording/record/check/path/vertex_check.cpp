// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/path/vertex_check.hpp"

#include <cmath>
#include <cstdio>

namespace meridian::record {
namespace {

/// Passed, but for what a chord cuts off a smooth motion.
[[nodiscard]] bool is_within(const VertexPass& pass, double tip_tolerance_mm) {
  constexpr double kWithin = 1 + 2 * kRoundingShare;
  return pass.share <= kWithin + kSag_mm / tip_tolerance_mm &&
         pass.tip_mm <= kWithin * tip_tolerance_mm + kSag_mm;
}

}  // namespace

std::uint32_t VertexCheck::line_of(std::size_t index) const noexcept {
  const auto& elements = path_.elements();
  return index == 0 || elements.empty() ? path_.begin_line() : elements[index - 1].line;
}

void VertexCheck::add(const VertexPass& pass) {
  if (path_.elements().empty() && pass.index > 0) return;  // a path that is one pose
  ++count_;
  const bool is_good = is_within(pass, tip_tolerance_);
  if (!is_good && pass.is_in_gap) {
    ++in_gaps_;
    return;
  }
  if (!std::isfinite(pass.share)) return;
  const std::uint32_t line = line_of(pass.index);
  farthest_.raise(pass.tip_mm, 0, line);
  if (is_good) return;
  if (pass.tip_mm > tip_tolerance_ * (1 + kRoundingShare)) {
    missed_.add(pass.tip_mm, 0, line);
  } else {
    unturned_.add(pass.share, 0, line);
  }
}

void VertexCheck::add(std::span<const VertexPass> passes) {
  for (const VertexPass& pass : passes) add(pass);
}

void VertexCheck::add_last(std::span<const VertexPass> passes) {
  for (const VertexPass& pass : passes) {
    if (!is_within(pass, tip_tolerance_)) return;
    add(pass);
  }
}

void VertexCheck::finish(CheckReport& report) const {
  report.vertices = count_;
  report.vertices_in_gaps = in_gaps_;
  report.vertex_mm = farthest_;
  char text[256];
  const auto find = [&](const Excess& excess) {
    report.findings.push_back({Finding::Kind::kVertex, text, 0, excess.worst.line, excess.count});
  };
  if (missed_.count > 0) {
    std::snprintf(text, sizeof text, "%llu CL vertices were missed, the worst by %.6f mm",
                  static_cast<unsigned long long>(missed_.count), missed_.worst.value);
    find(missed_);
  }
  if (unturned_.count > 0) {
    std::snprintf(text, sizeof text,
                  "the tool axis missed %llu CL vertices, the worst by %.3f tolerances",
                  static_cast<unsigned long long>(unturned_.count), unturned_.worst.value);
    find(unturned_);
  }
}

}  // namespace meridian::record
