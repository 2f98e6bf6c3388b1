// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

namespace meridian::dds {

/// DDS could not do at start-up what was asked; the message says what and how to mend it.
class DdsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How Cyclone is configured where the environment variable CYCLONEDDS_URI does not say.
enum class Transport : std::uint8_t {
  kLoopback,         ///< deploy/cyclonedds-loopback.xml: this host only
  kLoopbackRealtime  ///< deploy/cyclonedds-loopback-rt.xml: and receive threads of real-time class
};

/// What a program does whose transport leaves the host without an identity.
enum class OpenNetwork : std::uint8_t {
  kRefused,  ///< it does not start
  kAllowed   ///< it starts, and says so
};

struct ParticipantOptions {
  std::uint32_t domain = 0;
  std::string machine;  ///< name of the machine: the DDS partition
  Transport transport = Transport::kLoopback;
  OpenNetwork open_network = OpenNetwork::kAllowed;
};

/// One process's place in a DDS domain, in the partition of one machine. Threads of Cyclone inherit
/// the affinity of the thread that creates it. The first participant of a domain in a process
/// settles the transport. Readers and writers must go before it. Where the transport keeps to
/// loopback, Cyclone's sockets are bound to that device: it opens them for every interface.
class Participant {
 public:
  /// Throws DdsError.
  explicit Participant(const ParticipantOptions& options);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// Whether it has an identity and talks to nobody without one (docs/security.md).
  [[nodiscard]] bool is_secured() const noexcept { return is_secured_; }
  /// Whether its transport leaves the host (network_config.hpp).
  [[nodiscard]] bool leaves_host() const noexcept { return leaves_host_; }
  /// Whether anybody on a network may take part.
  [[nodiscard]] bool is_open_network() const noexcept { return leaves_host_ && !is_secured_; }
  [[nodiscard]] std::int32_t handle() const noexcept { return participant_; }
  [[nodiscard]] std::int32_t publisher() const noexcept { return publisher_; }
  [[nodiscard]] std::int32_t subscriber() const noexcept { return subscriber_; }

 private:
  std::int32_t domain_ = 0, participant_ = 0, publisher_ = 0, subscriber_ = 0;
  bool is_secured_ = false, leaves_host_ = false;
};

}  // namespace meridian::dds
