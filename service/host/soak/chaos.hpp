// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

namespace meridian::soak {

/// Something that goes wrong, or that somebody does.
enum class Mishap : std::uint8_t {
  kHold,           ///< the operator holds, and resumes after `value` s
  kOverride,       ///< the operator sets the feed override to `value`
  kAbort,          ///< the operator aborts the program
  kStationStops,   ///< the station stands still for `value` s: the machine starves
  kStationDies,    ///< the station is killed
  kDriveFault,     ///< a drive reports a fault
  kDriveBlocked,   ///< a drive stays where it is
  kDrivesSilent,   ///< the drives send nothing any more
  kEmergencyStop,  ///< the drives' emergency stop
  kServiceDies     ///< the service is killed
};
inline constexpr int kMishapCount = 10;
[[nodiscard]] const char* word(Mishap mishap) noexcept;
/// Whether it is of one drive, Planned::drive.
[[nodiscard]] constexpr bool is_of_drive(Mishap mishap) noexcept {
  return mishap == Mishap::kDriveFault || mishap == Mishap::kDriveBlocked;
}

struct Planned {
  Mishap mishap{};
  double at_s = 0;   ///< since the soak began
  double value = 0;  ///< what the mishap says
  int drive = 0;     ///< machine order
};

/// The schedule of mishaps: the same for the same seed. Distances are drawn between half and three
/// halves of `every_s`, overrides up to `max_override`, distances of mishaps of the drives between
/// one and four times that. Proof: tests/unit/soak/soak_test.cpp.
class Chaos {
 public:
  Chaos(std::uint64_t seed, double every_s, int drives, double max_override = 1);
  /// The next of operator, station and service.
  [[nodiscard]] Planned next();
  /// The next of the drives; `at_s` counts from when they are enabled.
  [[nodiscard]] Planned next_of_drives();

 private:
  std::mt19937_64 random_, drives_random_;
  double every_s_, at_s_ = 0, max_override_;
  int drives_;
};

}  // namespace meridian::soak
