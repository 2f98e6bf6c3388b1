// SPDX-License-Identifier: Apache-2.0
#include "integration/fault_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "integration/plant.hpp"
#include "meridian/units.hpp"

namespace meridian::test {
namespace {

constexpr double kFeed_mm_per_min = 1500;
constexpr int kCutsAround = 4;  ///< in front of the section and behind it
constexpr const char* kFeedWord = "FEDRAT/1500,MMPM";

[[nodiscard]] std::string go_to(const Vector3& tip, double tilt_deg, double azimuth_deg) {
  const double tilt = units::rad_from_deg(tilt_deg), azimuth = units::rad_from_deg(azimuth_deg);
  char text[160];
  std::snprintf(text, sizeof text, "GOTO/%.6f,%.6f,%.6f,%.12f,%.12f,%.12f", tip.x(), tip.y(),
                tip.z(), std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                std::cos(tilt));
  return text;
}

}  // namespace

FaultPart::FaultPart(const Phase& phase) {
  using Where = Phase::Where;
  for (const char* line : {"PARTNO FAULTS", "UNITS/MM", kFeedWord}) add(line);
  const std::vector<ClBlock> cuts = small_program(2 * kCutsAround + 9, kFeed_mm_per_min);
  Vector3 offset(0, 0, 0);
  std::size_t next = 0;
  const auto cut = [&](int count) {
    for (int n = 0; n < count; ++n, ++next) {
      std::vector<ClBlock> one{cuts[next]};
      one[0].tip_mm = to_array(Vector3(to_vector(cuts[next].tip_mm) + offset));
      std::string line = cl_text(one);
      line.pop_back();
      add_motion(line);
    }
  };
  cut(1 + kCutsAround);
  section = static_cast<std::uint32_t>(lines.size()) + 1;
  const Vector3 at = to_vector(cuts[next - 1].tip_mm);
  switch (phase.where) {
    case Where::kRapid:
      offset = {100, 0, 0};
      add("RAPID");
      cut(1);
      add(kFeedWord);
      break;
    case Where::kPole:
      offset = {4, 0, 0};
      add_motion(go_to(at + Vector3(2, 0, 0), 0, 0));
      add_motion(go_to(at + Vector3(4, 0, 0), 10, 80));
      break;
    case Where::kDwell:
      add("DELAY/1");
      break;
    case Where::kTool:
      add("LOADTL/2");
      break;
    default:
      cut(8);
  }
  section_end = static_cast<std::uint32_t>(lines.size());
  cut(kCutsAround - 1);
  offset += Vector3(10, 0, 0);  // some time for what happens in the last block
  cut(1);
  add("FINI");
}

std::string FaultPart::text_up_to(std::uint32_t line) const {
  std::string text;
  for (std::size_t n = 0; n < std::min<std::size_t>(line, lines.size()); ++n) {
    text += lines[n] + "\n";
  }
  return text;
}

}  // namespace meridian::test
