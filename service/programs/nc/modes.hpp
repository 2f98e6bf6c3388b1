// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "service/programs/cl/interpreter/modal.hpp"

namespace meridian::nc {

enum class Motion : std::uint8_t { kNone, kRapid, kLine, kClockwise, kCounterClockwise };

/// What X Y Z mean.
enum class Control : std::uint8_t {
  kNone,    ///< G49: the tip where nothing is tilted
  kLength,  ///< G43: the same
  kRotary,  ///< G43.4: the tip; the rotary words give the tool axis
  kVector   ///< G43.5: the tip; I J K are the tool axis
};
[[nodiscard]] constexpr bool holds_tip(Control control) noexcept {
  return control == Control::kRotary || control == Control::kVector;
}

enum class Language : std::uint8_t { kFanuc, kSiemens, kHeidenhain };

/// A canned cycle in force. Lengths in the unit of the program.
struct Cycle {
  std::uint8_t code = 0;      ///< 81 of G81; 0: none
  double initial = 0;         ///< where Z stood before it
  bool returns_to_r = false;  ///< G99; G98: to `initial`
  std::optional<double> r, z, peck;
  double dwell_s = 0;
};

/// Holes along Z of the program as their cycle defines them. Lengths in the unit of the program.
struct Drilling {
  cl::HoleCycle hole;
  double top = 0;  ///< Z of what the levels of `hole` count from
};

/// Which sense a rotary axis that turns without end takes to an absolute word.
enum class RotarySense : std::uint8_t {
  kAsWritten,  ///< M127 of Klartext, and everywhere else
  kShorter     ///< M126 of Klartext
};

/// What a coordinate counts from.
enum class Distance : std::uint8_t {
  kAbsolute,    ///< G90, G90.1: the zero
  kIncremental  ///< G91: where the tool stands; G91.1: the begin of the arc
};

/// How the blocks say the tool axis: TRAORI of Siemens, TCPM of Klartext, and the words beside
/// them. Each word changes one of the three and leaves the others.
struct Orientation {
  enum class Transformation : std::uint8_t {
    kOff,
    kOn  ///< vectors or rotary words, as each block has them
  };
  enum class Between : std::uint8_t {
    kEvenJoints,  ///< ORIAXES: between two blocks the rotary joints turn evenly
    kGreatCircle  ///< ORIVECT, PATHCTRL VECTOR: the axis goes on a great circle
  };
  enum class Axes : std::uint8_t {
    kOfPart,    ///< ORIWKS
    kOfMachine  ///< ORIMKS
  };
  Transformation transformation = Transformation::kOff;
  Between between = Between::kEvenJoints;
  Axes axes = Axes::kOfPart;
};

/// CYCL DEF of Klartext: a cycle with the Q parameters that the lines after it give.
struct CycleDefinition {
  int number = 0;
  std::map<int, double> parameters;
  bool runs_at_every_point = false;  ///< M89
};

/// CYCL DEF of Klartext: a cycle of the control, which is refused where it is defined.
struct RefusedCycle {};

/// The last CYCL DEF of Klartext that is called; nothing: none.
using CalledCycle = std::variant<std::monostate, CycleDefinition, RefusedCycle>;

/// What lines of Q parameters alone belong to, in Klartext.
enum class OpenDefinition : std::uint8_t {
  kNone,
  kCycle,  ///< the cycle in force, which may be a refused one
  kPreset  ///< CYCL DEF 247
};

/// Everything modal but feed, spindle, unit and tool, which cl::Modal has.
struct Modes {
  Motion motion = Motion::kNone;
  Control control = Control::kNone;
  std::uint8_t plane = 2;  ///< the axis across it
  Distance distance = Distance::kAbsolute;
  Distance centre = Distance::kIncremental;  ///< of an arc
  cl::FeedUnit feed_unit = cl::FeedUnit::kPerMinute;
  Cycle cycle;
  std::optional<Drilling> at_every_point;  ///< MCALL of Siemens
  CalledCycle definition;
  OpenDefinition open = OpenDefinition::kNone;
  int work_offset = 0;   ///< code in tenths, with P of G54.1 in thousands; 0: none given
  int moved_offset = 0;  ///< the one under which the tool has moved last
  std::optional<std::uint32_t> next_tool;
  Language language = Language::kFanuc;
  std::array<std::optional<double>, 2> pole;  ///< CC of Klartext
  double auto_feed = 0;        ///< F of TOOL CALL in Klartext, which FAUTO means; 0: none
  bool has_new_speed = false;  ///< TOOL CALL S of Klartext, for a spindle that turns
  Orientation orientation;
  /// AXIS SPAT of Klartext: the last A, B and C, deg, which turn the tool about the fixed x, then
  /// y, then z; nothing: they are positions of rotary axes.
  std::optional<std::array<std::optional<double>, 3>> in_space_deg;
  RotarySense rotary_sense = RotarySense::kAsWritten;
  bool has_dynamic_offset = false;  ///< G254: the plane is that of the rotary words

  [[nodiscard]] bool is_incremental() const noexcept { return distance == Distance::kIncremental; }
  [[nodiscard]] bool is_oriented() const noexcept {
    return orientation.transformation == Orientation::Transformation::kOn;
  }
  [[nodiscard]] bool turns_evenly() const noexcept {
    return orientation.between == Orientation::Between::kEvenJoints;
  }
};

/// A rotary axis as the program has turned it, deg as written; nothing: by the control, unknown.
struct RotaryAt {
  std::string address;
  std::optional<double> deg;
  /// An axis that turns without end and was sent to a place within a turn (DC, M126): it stands
  /// there for the words that follow. `deg` counts on: from 350 by DC(10) to 370, which is 10.
  bool is_within_turn = false;
};

/// Where the program has put the tool. Lengths in the unit of the program, from its zero.
struct ToolPosition {
  std::array<std::optional<double>, 3> tip;     ///< nothing: not known here
  std::vector<RotaryAt> rotary;                 ///< of every axis that was programmed
  std::optional<std::array<double, 3>> vector;  ///< of G43.5, unit; nothing: none was given
  bool is_by_control = false;  ///< the control has turned rotary axes, to where is not known

  [[nodiscard]] bool is_known() const noexcept { return tip[0] && tip[1] && tip[2]; }
  void forget() noexcept { tip = {}; }
  [[nodiscard]] bool is_turned() const noexcept;
};

}  // namespace meridian::nc
