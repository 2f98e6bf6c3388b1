// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"

/// What may go wrong on purpose with simulated drives; docs/faults.md says what the machine does.
namespace meridian::drives {

/// Something that goes wrong on purpose, `after_s` after operation was enabled.
struct Injection {
  enum class Kind : std::uint8_t {
    kFault,         ///< drive `drive` reports a device fault
    kBlocked,       ///< the shaft of `drive` is stuck: following error
    kSilence,       ///< no more feedback
    kEmergency,     ///< the stop input opens
    kDead,          ///< the drives' controller hangs: nothing is taken, followed or reported
    kUnpowered,     ///< the power stage of `drive` goes off: it leaves operation without a fault
    kUnreferenced,  ///< `drive` has lost its reference
    kMute,          ///< `drive` alone is missing in the reports
    kFrozen,        ///< `drive` reports the same position for ever, and goes on
    kNoNumber,      ///< `drive` reports a position that is no number
    kSpike,         ///< one report of `drive` is off by `value` mm or rad
    kLag,           ///< `drive` follows with a time constant of `value` s
    kDeaf,          ///< setpoints do not arrive for `value` periods
    kLate,          ///< setpoints arrive `value` periods late from now on
    kUnreported,    ///< reports do not say which setpoint was taken
    kStale,         ///< reports arrive `value` periods late from now on
    kDoubled,       ///< every report arrives twice
    kSwapped,       ///< every other report is overtaken by the one behind it
    kGuard,         ///< a guard of the work space opens
    kCreep,         ///< the reported position of `drive` creeps by `value` mm or rad per second
    kMend           ///< everything of the above is as it was
  };
  Kind kind = Kind::kFault;
  double after_s = 0;
  int drive = 0;
  double value = 0;
};

/// How a kind is written, KIND[@SECONDS][:DRIVE][=VALUE].
struct InjectionWord {
  Injection::Kind kind;
  const char* word;
  bool has_drive;
  double value;        ///< without =VALUE, as it is written; 0: takes none
  const char* unit;    ///< of VALUE; nullptr: takes none
  const char* effect;  ///< in words
};
[[nodiscard]] std::span<const InjectionWord> injection_words() noexcept;
/// "fault, blocked, ...".
[[nodiscard]] std::string all_injection_words();

/// Reads an injection; the error is a sentence. Values are written in mm, deg, ms or periods.
/// Proof: tests/unit/simulated_drives/injection_test.cpp.
[[nodiscard]] Expected<Injection, std::string> parse_injection(const std::string& text,
                                                               const MachineModel& model);

}  // namespace meridian::drives
