// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "service/drives/kit/master.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::drive {

/// How many lost setpoints a service wants bridged, and which service that is.
struct Bridge {
  Master by;
  int cycles = 0;
};

/// What a service says of itself, in so far as drives care. `sender`: participant of its writer.
[[nodiscard]] inline std::optional<Bridge> bridge_of(const dds::MachineInfo& machine,
                                                     std::uint64_t sender) noexcept {
  if (!machine.is_serving || sender == 0) return std::nullopt;
  return Bridge{{sender, machine.service_id}, static_cast<int>(machine.bridge_cycles)};
}

/// Who takes what the wire brings for drives. RT: nothing here waits or allocates.
class Receiver {
 public:
  virtual ~Receiver() = default;

  /// `sender`: dds::participant_of() its writer; 0: not known.
  virtual Drop take(const dds::DriveCommand& command, std::uint64_t sender) noexcept = 0;
  /// `arrival_ns`: by the receiver's clock; 0: not known, and age is not checked.
  virtual Drop take(const dds::SetpointSample& setpoint, std::uint64_t sender,
                    std::int64_t arrival_ns) noexcept = 0;
  /// How many periods are bridged says the master: what others say under its id counts for nothing.
  virtual void take(const Bridge& bridge) noexcept = 0;
  /// Once a period, before work(): whether DDS still knows the master's writer.
  virtual void see_master(bool is_there) noexcept = 0;
  [[nodiscard]] virtual const MasterPin& pin() const noexcept = 0;

 protected:
  Receiver() = default;
  Receiver(const Receiver&) = default;
  Receiver& operator=(const Receiver&) = default;
};

}  // namespace meridian::drive
