// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "service/transport/convert/messages.hpp"

namespace meridian::drives {

/// Who speaks to the drives that are checked.
enum class Speaker : std::uint8_t { kService, kOther };
/// What the operator is asked to do.
enum class Wish : std::uint8_t { kOpenEmergencyStop, kCloseEmergencyStop };

/// Drives that are checked, behind whatever brings samples to them.
class CheckedDrives {
 public:
  virtual ~CheckedDrives() = default;
  virtual void say(Speaker who, const dds::MachineInfo& machine) = 0;
  virtual void say(Speaker who, const dds::DriveCommand& command) = 0;
  virtual void say(Speaker who, const dds::SetpointSample& setpoint) = 0;
  /// That service is gone, with everything of it.
  virtual void end(Speaker who) = 0;
  /// That service starts again, as another participant.
  virtual void begin(Speaker who) = 0;
  /// May take its time: the drives' reports show it.
  virtual void ask(Wish wish) = 0;
  /// A period goes by: adds the reports that came. False: this program overslept, and what the
  /// drives do now proves nothing.
  [[nodiscard]] virtual bool period(std::vector<dds::DriveFeedback>& reports) = 0;
  /// By the clock that setpoints are due by.
  [[nodiscard]] virtual std::int64_t now_ns() const = 0;

 protected:
  CheckedDrives() = default;
  CheckedDrives(const CheckedDrives&) = default;
  CheckedDrives& operator=(const CheckedDrives&) = default;
};

}  // namespace meridian::drives
