// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <string_view>

#include "attack/wire.hpp"

namespace attack {

/// What a sample that is sent says.
enum class Shape : std::uint8_t {
  kWell,       ///< as somebody new in the room would say it, with ids of his own
  kMalformed,  ///< random in every field: ids, enumerations, NaN, control characters, CRC
  kForged,     ///< quotes the ids that were heard, and is ahead of their numbers
  kForeign     ///< bytes of another type: for foreign writers
};
[[nodiscard]] Shape shape_named(std::string_view name);

/// The newest of what others say, to quote it.
struct Heard {
  meridian_wire_Status status{};
  meridian_wire_Machine machine{};
  meridian_wire_Setpoint setpoint{};
  meridian_wire_DriveCommand drive_command{};
  meridian_wire_Feedback feedback{};
  meridian_wire_Command command{};
  meridian_wire_Reply reply{};
  meridian_wire_ClCredit credit{};
  meridian_wire_Action action{};
  meridian_wire_Jog jog{};
};

/// Listens to everything that can be quoted. The first service and drives that are heard are those
/// that it stays with.
class Ears {
 public:
  explicit Ears(const Wire& wire);
  /// Takes what came.
  void listen();
  /// Listens until a status has come, for `patience_ns` at the longest.
  [[nodiscard]] bool waits_for_status(std::int64_t patience_ns);
  [[nodiscard]] const Heard& heard() const noexcept { return heard_; }

 private:
  struct Readers {
    dds_entity_t status, machine, setpoint, drive_command, feedback, command, reply, credit, action,
        jog;
  };
  Readers readers_{};
  Heard heard_{};
};

/// Makes samples of a topic, one after the other.
class Maker {
 public:
  /// `asked`: the verb of commands; 255: another one each time, those that stop left out.
  Maker(const Topic& topic, Shape shape, std::uint64_t seed, int asked = 255);
  /// The next one; valid until the next call.
  [[nodiscard]] const void* next(const Heard& heard);

 private:
  const Topic& topic_;
  Shape shape_;
  std::mt19937_64 random_;
  int asked_;
  std::uint64_t number_ = 0;
  std::uint64_t own_id_;
  std::unique_ptr<std::max_align_t[]> memory_;
};

/// Setpoints with such cycles are ours: a drive that reports one has followed it.
inline constexpr std::uint64_t kMark = 1ULL << 40U;

}  // namespace attack
