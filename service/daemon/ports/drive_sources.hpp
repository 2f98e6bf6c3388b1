// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "meridian/cycle/cycle_data.hpp"

namespace meridian::interpolator {

/// What a source says of a guard of the work space.
enum class GuardInput : std::uint8_t {
  kNone,  ///< it never said that one is open: it may have none
  kShut,  ///< it has one, which is shut; its silence is an open guard
  kOpen
};

/// One writer's word on one drive group.
struct DriveSource {
  std::uint64_t writer = 0;  ///< dds::SampleInfo::source; 0: place is free
  std::uint32_t group = 0;
  std::uint32_t claimed_mask = 0;  ///< joints of the machine that it reports
  std::uint32_t bound_mask = 0;    ///< joints of the machine that it alone may report
  std::uint64_t sample = 0;
  std::uint64_t cycle_seen = 0;
  std::uint64_t master = 0;                   ///< service that its drives obey; 0: nobody
  std::int64_t first_ns = 0, arrival_ns = 0;  ///< of its first and its newest sample
  bool has_only_stop = false;                 ///< it has no joint of any machine: a stop input
  bool is_emergency_stop = false;
  GuardInput guard = GuardInput::kNone;
  ProbeInput probe = ProbeInput::kNone;

  /// The joints that the machine takes from it.
  [[nodiscard]] std::uint32_t joints() const noexcept { return claimed_mask & bound_mask; }
};

/// Everybody who reports drives, for the messages to the operator.
struct DriveSources {
  std::array<DriveSource, 16> slots{};
  bool is_full = false;  ///< somebody more found no place
};
static_assert(std::is_trivially_copyable_v<DriveSources>);

/// Whether `other` reports, as `owner` does all the while, joints that are bound to `owner`; who
/// has not spoken for `silence_ns` does not. One that took over from a source that died is no
/// second one: the dead did not speak after it had come.
[[nodiscard]] constexpr std::uint32_t contested(const DriveSource& owner, const DriveSource& other,
                                                std::int64_t now_ns,
                                                std::int64_t silence_ns) noexcept {
  const bool is_both = now_ns - owner.arrival_ns <= silence_ns &&
                       now_ns - other.arrival_ns <= silence_ns && owner.arrival_ns > other.first_ns;
  return is_both && &owner != &other ? owner.bound_mask & other.claimed_mask : 0;
}

/// The service that the drives of the machine obey, by those who spoke within a second: `own` as
/// soon as one obeys it, 0 where none says whom, or two say different ones.
[[nodiscard]] constexpr std::uint64_t master_of(const DriveSources& sources, std::uint64_t own,
                                                std::int64_t now_ns) noexcept {
  constexpr std::int64_t kRecent_ns = 1'000'000'000;
  std::uint64_t master = 0;
  bool is_agreed = true;
  for (const DriveSource& source : sources.slots) {
    if (source.writer == 0 || source.joints() == 0 || source.master == 0) continue;
    if (now_ns - source.arrival_ns > kRecent_ns) continue;
    if (source.master == own) return own;
    is_agreed = is_agreed && (master == 0 || master == source.master);
    master = source.master;
  }
  return is_agreed ? master : 0;
}

}  // namespace meridian::interpolator
