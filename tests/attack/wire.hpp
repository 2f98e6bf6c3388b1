// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cl.h>
#include <dds/dds.h>
#include <drives.h>
#include <operator.h>
#include <status.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What an outsider has: the wire types of idl/, Cyclone DDS, and docs/topics.md. Nothing of the
/// project's own code is included or linked here, so that a fault of it cannot hide itself.
namespace attack {

enum class Quality : std::uint8_t { kStream, kLatest, kSnapshot, kCyclic, kSetpoint, kJog };

/// A topic as docs/topics.md describes it.
struct Topic {
  const char* name;  ///< without "meridian/"
  const dds_topic_descriptor_t* descriptor;
  Quality quality;
  std::size_t size;  ///< of its sample, bytes
};

[[nodiscard]] std::span<const Topic> topics();
/// Ends the program where there is no such topic.
[[nodiscard]] const Topic& topic_named(std::string_view name);
/// "all", or names with commas between them.
[[nodiscard]] std::vector<const Topic*> topics_named(std::string_view names);

/// Of the participant, and of what a reader may keep.
struct Limits {
  int max_samples = 0;  ///< of a reader; 0: no limit
  int depth = 0;        ///< of a best effort reader; 0: as the topic says
};

/// A participant of its own domain configuration, loopback only: the shipped one admits few.
class Wire {
 public:
  /// `lease_s`: for how long others take it for alive after its last word.
  Wire(int domain, const std::string& machine, double lease_s = 1);
  ~Wire();
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;

  [[nodiscard]] dds_entity_t reader(const Topic& topic, const Limits& limits = {}) const;
  [[nodiscard]] dds_entity_t writer(const Topic& topic) const;
  /// A writer on that topic whose samples have the shape of another type: nobody can read them.
  [[nodiscard]] dds_entity_t foreign_writer(const Topic& topic, const Topic& shape) const;
  [[nodiscard]] dds_entity_t participant() const noexcept { return participant_; }
  /// Process that a writer belongs to, as its participant says; 0: not known (yet).
  [[nodiscard]] long process_of(dds_entity_t reader, dds_instance_handle_t writer) const;

 private:
  dds_entity_t participant_ = 0, publisher_ = 0, subscriber_ = 0, participants_ = 0;
};

/// Ends the program with what went wrong where `result` is negative.
dds_entity_t must(dds_entity_t result, const char* what);

[[nodiscard]] std::int64_t monotonic_ns() noexcept;
void sleep_ns(std::int64_t duration_ns) noexcept;

/// CRC-32C (RFC 3720), bit by bit.
[[nodiscard]] std::uint32_t crc32c(const void* data, std::size_t size, std::uint32_t seed = 0);
/// As idl/README.md says it.
[[nodiscard]] std::uint32_t crc_of(const meridian_wire_ClBatch& batch);
[[nodiscard]] std::uint32_t crc_of(const meridian_wire_Setpoint& setpoint,
                                   std::uint64_t service_id);

}  // namespace attack
