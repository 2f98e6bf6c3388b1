// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/chaos.hpp"

#include <array>

namespace meridian::soak {
namespace {

constexpr std::array<const char*, kMishapCount> kWords{
    "hold",        "override",      "abort",         "station stops",  "station dies",
    "drive fault", "drive blocked", "drives silent", "emergency stop", "service dies"};
constexpr int kDriveMishaps = 4;
constexpr std::size_t kFirstOfDrives = 5;
/// How often each is drawn: what an operator does is frequent, a service that dies is rare.
constexpr std::array<int, kMishapCount> kWeights{6, 6, 2, 3, 2, 0, 0, 0, 0, 1};

/// Not by the library's distributions: those may differ from one library to the next.
[[nodiscard]] double draw(std::mt19937_64& random, double low, double high) {
  constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
  return low + (high - low) * static_cast<double>(random() >> 11U) * kUnit;
}

}  // namespace

const char* word(Mishap mishap) noexcept { return kWords[static_cast<std::size_t>(mishap)]; }

Chaos::Chaos(std::uint64_t seed, double every_s, int drives, double max_override)
    : random_(seed),
      drives_random_(~seed),
      every_s_(every_s),
      max_override_(max_override),
      drives_(drives) {}

Planned Chaos::next() {
  at_s_ += draw(random_, 0.5, 1.5) * every_s_;
  int total = 0;
  for (const int weight : kWeights) total += weight;
  int drawn = static_cast<int>(draw(random_, 0, total));
  std::size_t which = 0;
  while (drawn >= kWeights[which]) drawn -= kWeights[which++];
  Planned planned{static_cast<Mishap>(which), at_s_, 0, 0};
  if (planned.mishap == Mishap::kOverride) planned.value = draw(random_, 0.2, max_override_);
  if (planned.mishap == Mishap::kHold) planned.value = draw(random_, 0.1, 2);
  if (planned.mishap == Mishap::kStationStops) planned.value = draw(random_, 0.3, 3);
  return planned;
}

Planned Chaos::next_of_drives() {
  const auto which = static_cast<std::size_t>(draw(drives_random_, 0, kDriveMishaps));
  const double at_s = draw(drives_random_, 1, 4) * every_s_;
  const int drive = static_cast<int>(draw(drives_random_, 0, drives_));
  return {static_cast<Mishap>(kFirstOfDrives + which), at_s, 0, drive};
}

}  // namespace meridian::soak
