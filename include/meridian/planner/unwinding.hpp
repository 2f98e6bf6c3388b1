// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace meridian {

/// An unwinding in the plan: the redundant joint would have left its travel in a block, and is
/// turned back ahead of it, off the part (UnwindPolicy::kRetract). Units: rad, mm.
struct Unwinding {
  std::uint64_t sequence = 0;  ///< block in which the travel would have ended
  std::uint32_t line = 0;      ///< its source line
  std::int32_t turns = 0;      ///< whole turns of the redundant joint; 0: no unwinding
  double from_rad = 0;         ///< where it stood
  double retract_mm = 0;       ///< how far the tool leaves the part
};

/// Reports for every winding whether what follows an unwinding keeps travel on it.
class WindingTrial {
 public:
  virtual ~WindingTrial() = default;
  /// With the redundant joint turned by whole `turns` from where it rests.
  [[nodiscard]] virtual bool fits(int turns) const noexcept = 0;
};

}  // namespace meridian
