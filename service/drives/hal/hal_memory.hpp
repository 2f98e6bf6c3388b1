// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "service/drives/hal/shared.h"

namespace meridian::hal {

/// The memory that this process shares with the component of HAL. Whoever comes first makes it; it
/// stays when both are gone, so that either side may be started again. Context: start-up.
/// Proof: tests/unit/hal/hal_hardware_test.cpp.
class HalMemory {
 public:
  /// Throws std::runtime_error that names the memory and the reason.
  explicit HalMemory(const std::string& machine);
  ~HalMemory();
  HalMemory(const HalMemory&) = delete;
  HalMemory& operator=(const HalMemory&) = delete;

  [[nodiscard]] meridian_hal_shared& get() const noexcept { return *shared_; }

 private:
  meridian_hal_shared* shared_ = nullptr;
};

}  // namespace meridian::hal
