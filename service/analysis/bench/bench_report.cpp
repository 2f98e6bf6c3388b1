// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "meridian/units.hpp"
#include "service/analysis/bench/bench_run.hpp"
#include "service/text/printed.hpp"

namespace meridian::bench {
namespace {

/// The largest share of any joint's limit.
double largest(const record::CheckReport& verdict, record::Peak record::JointUse::*of) {
  double max = 0;
  for (int i = 0; i < verdict.joint_count; ++i) {
    max = std::max(max, (verdict.joints[static_cast<std::size_t>(i)].*of).value);
  }
  return max;
}

}  // namespace

std::string table_header() {
  return "path              policy   time s  tip um  axis deg  vertex um    feed     vel     acc   "
         " "
         "jerk  axis, deg  verdict\n";
}

std::string table_row(const BenchResult& result) {
  constexpr double kUm_per_mm = 1000;
  const record::CheckReport& v = result.verdict;
  std::string out;
  text::append(out, "%-17s %-6s %8.3f %7.2f %9.4f %10.2f %7.4f %7.4f %7.4f %7.4f %10.4f  ",
               result.path.c_str(), result.policy == PolePolicy::kExact ? "exact" : "ease",
               result.plan.program_s, kUm_per_mm * v.tip_mm.value,
               units::deg_from_rad(v.axis_rad.value), kUm_per_mm * v.vertex_mm.value, v.feed.value,
               largest(v, &record::JointUse::velocity), largest(v, &record::JointUse::acceleration),
               largest(v, &record::JointUse::jerk),
               units::deg_from_rad(result.plan.largest_deviation_rad));
  out += v.passed() ? "PASS" : "FAIL: " + v.findings.front().text;
  if (result.certificate) out += result.certificate->is_given() ? ", certified" : ", NOT certified";
  return out + "\n";
}

}  // namespace meridian::bench
