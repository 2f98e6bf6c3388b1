// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "meridian/cycle/cycle_data.hpp"

namespace meridian::test {

/// An alarm after a FaultStop as in the tables of docs/faults.md; one that has no letter there by
/// its number.
[[nodiscard]] inline std::string letter_of(Alarm alarm) {
  switch (alarm) {
    case Alarm::kDriveFault:
      return "D";
    case Alarm::kFeedbackLost:
      return "L";
    case Alarm::kFollowingError:
      return "F";
    case Alarm::kEmergencyStop:
      return "E";
    case Alarm::kReferenceLost:
      return "R";
    case Alarm::kEnableTimeout:
      return "T";
    case Alarm::kPeriodsLost:
      return "P";
    case Alarm::kSetpointsUnheard:
      return "U";
    case Alarm::kDrivesAstray:
      return "A";
    case Alarm::kStandstill:
      return "S";
    case Alarm::kJointSpeed:
      return "V";
    case Alarm::kTipSpeed:
      return "Y";
    case Alarm::kPositionWindow:
      return "W";
    case Alarm::kDriveModel:
      return "M";
    case Alarm::kFeedbackJump:
      return "J";
    case Alarm::kFeedbackFrozen:
      return "Z";
    case Alarm::kFeedbackTooFast:
      return "Q";
    default:
      return "alarm " + std::to_string(static_cast<int>(alarm));
  }
}

}  // namespace meridian::test
