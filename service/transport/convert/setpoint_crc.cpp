// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstddef>

#include "service/transport/convert/crc32c.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::dds {

// The memory of a Setpoint is its canonical encoding: no padding, the wire's field order.
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(Setpoint) == 120 && offsetof(Setpoint, cycle) == 0 &&
              offsetof(Setpoint, due_ns) == 8 && offsetof(Setpoint, position) == 16 &&
              offsetof(Setpoint, velocity) == 64 && offsetof(Setpoint, line) == 112 &&
              offsetof(Setpoint, epoch) == 116 && offsetof(Setpoint, flags) == 118);

std::uint32_t setpoint_crc(const Setpoint& setpoint, std::uint64_t service_id) noexcept {
  return crc32c(std::as_bytes(std::span(&setpoint, 1)),
                crc32c(std::as_bytes(std::span(&service_id, 1))));
}

}  // namespace meridian::dds
