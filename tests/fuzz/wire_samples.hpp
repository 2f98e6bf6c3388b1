// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace meridian::fuzz {

/// The byte before each sample says what it is.
enum SampleType : std::uint8_t {
  kBatch,     ///< its head, then blocks; the CRC is made to fit
  kRawBatch,  ///< as it comes off the wire, like all others
  kSession,
  kCredit,
  kCommand,  ///< in front of it the rest that the machine is at (from 128 on: and it waits for the
             ///< next one), and the one that was reported
  kReply,
  kJog,
  kSetpoint,
  kDriveCommand,
  kFeedback,
  kAction,
  kActionDone,
  kStatus,
  kMachine,
  kLatency,
  kTypes
};

/// What a sample may have or not, and so must have been checked with and without.
enum WireChoice : std::uint8_t {
  kInverseTime,
  kArc,
  kRest,  ///< a start or resume that was let through, after a block
  kForDryRunAlone,
  kReplyOfDryRun,
  kReplyWithApproach,
  kSetpointOfDryRun,
  kStatusOfDryRun,
  kSingleBlock,
  kOptionalStops,
  kStatusWithApproach,
  kStatusWithSummary,
  kHandOnAJoint,     ///< a sample that a hand's machine takes
  kOvertakenByStop,  ///< a word that waited, with a stop after it
  kLeaseLeft,        ///< to another service that serves the machine
  kWireChoices
};

/// Of each: checked without, checked with.
using WireChoices = std::array<std::array<bool, 2>, kWireChoices>;

/// What check_wire() has come to since the process began.
[[nodiscard]] const WireChoices& wire_choices();

}  // namespace meridian::fuzz
