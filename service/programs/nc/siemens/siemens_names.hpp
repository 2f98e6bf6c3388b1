// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "service/programs/nc/state.hpp"

namespace meridian::nc {

/// What a name of the language does here.
enum class NameKind : std::uint8_t {
  kOn,           ///< TRAORI
  kOff,          ///< TRAFOOF
  kGreatCircle,  ///< ORIVECT
  kEvenJoints,   ///< ORIAXES
  kPart,         ///< ORIWKS: directions of the part
  kMachine,      ///< ORIMKS
  kMachinePosition,
  kNothing,  ///< says how the control smooths or what it shows
  kFrame,
  kModalCall,  ///< MCALL
  kRefused
};

struct NameRow {
  std::string_view name;
  NameKind kind;
  std::string_view note = {};  ///< why it is refused
};

/// Every name but those of the drilling cycles. Proof: tests/unit/nc/siemens_name_rows_test.cpp.
[[nodiscard]] std::span<const NameRow> name_rows() noexcept;

/// What the names of a line say about its other words.
struct NameOutcome {
  bool has_machine_position = false;  ///< SUPA: they are positions of the machine
  bool has_frame = false;             ///< they are those of a frame, which is in force now
  enum class Holes : std::uint8_t {
    kAsBefore,
    kHere,          ///< CYCLE81(...): one, where the tool stands
    kAtEveryPoint,  ///< MCALL CYCLE81(...): after every motion from the next line on
    kNoMore         ///< MCALL alone
  };
  Holes holes = Holes::kAsBefore;
  Drilling drilling;  ///< of kHere and kAtEveryPoint
};

/// Puts the names of a Siemens line in force: TRAORI, ORIVECT, TRANS and their kin. Jumps,
/// subprograms and most cycles are refused by name. Proof: tests/unit/nc/siemens_test.cpp.
[[nodiscard]] Expected<NameOutcome, cl::Refusal> take_names(State& s, const Line& line);

/// Refuses what only a control can run by its name, however the rest of the line reads.
[[nodiscard]] cl::Outcome check_names(const Line& line);

/// Addresses that the language has beside single letters.
[[nodiscard]] cl::Outcome check_siemens_addresses(const State& s, const Line& line);

}  // namespace meridian::nc
