// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/sample_part.hpp"

#include <cmath>
#include <numbers>

#include "meridian/geometry/vector3.hpp"
#include "service/programs/cl/cl_writer.hpp"
#include "service/programs/surface/sample_blocks.hpp"
#include "service/programs/surface/shape/side_milling.hpp"

namespace meridian::surface {
namespace {

constexpr double kDomeRadius_mm = 100;
constexpr double kPetal_mm = 57;  // sin 34.75 deg of the dome's radius
constexpr int kPetals = 3;
constexpr int kBlocksPerHalfPetal = 24;
constexpr double kClear_mm = 40;
constexpr double kNear_mm = 5;
constexpr double kPlungeFeed_mm_per_min = 1200;
constexpr double kFeed_mm_per_min = 3000;
constexpr double kSpindle_rpm = 12000;

/// The dome's point and outward normal at polar angle `phi` of the rose.
ToolPose on_dome(double phi) {
  const double radius = kPetal_mm * std::cos(kPetals * phi);
  const double tilt = std::asin(radius / kDomeRadius_mm);
  const Vector3 normal{std::sin(tilt) * std::cos(phi), std::sin(tilt) * std::sin(phi),
                       std::cos(tilt)};
  return {kDomeRadius_mm * (normal - Vector3::UnitZ()), normal};
}

/// Polar angles that cut the half petal from `begin` to `end` into pieces of equal length.
std::vector<double> equal_steps(double begin, double end, int count) {
  constexpr int kFine = 4000;
  std::vector<double> length(kFine + 1, 0.0);
  Vector3 last = on_dome(begin).tip;
  const auto angle = [&](int i) { return begin + (end - begin) * i / kFine; };
  for (int i = 1; i <= kFine; ++i) {
    const Vector3 tip = on_dome(angle(i)).tip;
    length[static_cast<std::size_t>(i)] =
        length[static_cast<std::size_t>(i - 1)] + (tip - last).norm();
    last = tip;
  }
  std::vector<double> angles;
  int at = 0;
  for (int step = 1; step <= count; ++step) {
    const double wanted = length.back() * step / count;
    while (at < kFine && length[static_cast<std::size_t>(at)] < wanted) ++at;
    angles.push_back(step == count ? end : angle(at));
  }
  return angles;
}

}  // namespace

std::vector<ClBlock> blossom() {
  std::vector<ClBlock> blocks;
  const ToolPose begin = on_dome(0);
  blocks.push_back(action(BlockKind::kTool, ActionKind::kToolChange, 1));
  blocks.push_back(action(BlockKind::kAuxiliary, ActionKind::kSpindleClockwise, kSpindle_rpm));
  blocks.push_back(motion(BlockKind::kRapid, above(begin, kClear_mm), 0));
  blocks.push_back(action(BlockKind::kAuxiliary, ActionKind::kCoolantFlood, 0));
  blocks.push_back(motion(BlockKind::kRapid, above(begin, kNear_mm), 0));
  blocks.push_back(motion(BlockKind::kCut, begin, kPlungeFeed_mm_per_min));
  ToolPose last = begin;
  for (int half = 0; half < 2 * kPetals; ++half) {
    const double from = std::numbers::pi / (2 * kPetals) * half;
    const double to = std::numbers::pi / (2 * kPetals) * (half + 1);
    int step = 0;
    for (const double phi : equal_steps(from, to, kBlocksPerHalfPetal)) {
      const bool is_middle = ++step == kBlocksPerHalfPetal && half % 2 == 0;
      last = is_middle ? ToolPose{Vector3::Zero(), Vector3::UnitZ()} : on_dome(phi);
      blocks.push_back(motion(BlockKind::kCut, last, kFeed_mm_per_min));
    }
  }
  blocks.push_back(motion(BlockKind::kRapid, above(last, kClear_mm), 0));
  blocks.push_back(action(BlockKind::kAuxiliary, ActionKind::kCoolantOff, 0));
  blocks.push_back(action(BlockKind::kAuxiliary, ActionKind::kSpindleOff, 0));
  blocks.push_back(action(BlockKind::kEnd, ActionKind::kNone, 0));
  return blocks;
}

std::vector<std::string> sample_names() { return {"blossom", "side-milling"}; }

bool write_sample(std::string_view name, std::ostream& out) {
  if (name == "blossom") {
    cl::ClWriter writer(out, "MERIDIAN BLOSSOM");
    writer.note(
        "Three petals on a dome of 100 mm radius, tool along the normal, through the pole.");
    writer.note("Made by: meridian surface --sample blossom");
    for (const ClBlock& block : blossom()) writer.write(block);
    return true;
  }
  if (name != "side-milling") return false;
  cl::ClWriter writer(out, "MERIDIAN SIDE MILLING");
  writer.note("A ruled wall of 80 by 20 mm cut by the flank of an end mill of 10 mm.");
  writer.note("Made by: meridian surface --sample side-milling");
  for (const ClBlock& block : side_milling()) writer.write(block);
  return true;
}

std::string sample_report(std::string_view name) {
  return name == "side-milling" ? side_milling_report() : std::string();
}

}  // namespace meridian::surface
