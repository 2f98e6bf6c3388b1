// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace meridian::fuzz {

/// The byte before each sample says what it is.
enum SampleType : std::uint8_t {
  kBatch,     ///< its head, then blocks; the CRC is made to fit
  kRawBatch,  ///< as it comes off the wire, like all others
  kSession,
  kCredit,
  kCommand,
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

}  // namespace meridian::fuzz
