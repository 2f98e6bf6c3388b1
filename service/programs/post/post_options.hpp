// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace meridian::post {

/// Which words a program is written in. docs/postprocessor.md has every word of each.
enum class Dialect : std::uint8_t {
  kJoints,      ///< RS-274: joint positions, feed in inverse time; no tool-centre control needed
  kFanuc,       ///< G43.4 with rotary words, or G43.5 with I J K
  kSiemens,     ///< TRAORI with A3= B3= C3=
  kHeidenhain,  ///< FUNCTION TCPM and LN with TX TY TZ
  kKrl,         ///< KUKA: PTP with the axes' angles
  kRapid,       ///< ABB: MoveAbsJ with the time of each move
  kLs,          ///< FANUC robots: J moves with the time of each, positions as joints
  kUrScript     ///< Universal Robots: movej with the time of each move
};

/// Joint moves in the language of a robot's controller; not NC blocks.
[[nodiscard]] constexpr bool is_robot_language(Dialect dialect) noexcept {
  return dialect == Dialect::kKrl || dialect == Dialect::kRapid || dialect == Dialect::kLs ||
         dialect == Dialect::kUrScript;
}

inline constexpr int kRobotAxes = 6;  ///< of the arm; more of them are not written

/// What `meridian post` takes beside program and machine. Units: mm, rad, s.
struct PostOptions {
  Dialect dialect = Dialect::kJoints;
  bool has_vectors = false;            ///< kFanuc: G43.5 I J K instead of G43.4 and rotary words
  std::optional<double> chord_mm;      ///< nothing: the machine file's tolerance of the tip
  std::optional<double> axis_rad;      ///< nothing: the machine file's tolerance of the axis
  double rapid_feed_mm_per_s = 0;      ///< 0: rapids are G0; else cuts at this feed
  std::string work_offset = "G54";     ///< kHeidenhain has none
  std::optional<std::string> retract;  ///< the machine's own block instead of the dialect's
  std::string through_coolant;         ///< the machine's word for coolant through the tool, M88
  int offset_number = 0;               ///< kFanuc: H where the program calls no tool; 0: none given
  bool has_line_words = false;         ///< N words: the line of the CL file
  int program_number = 0;              ///< kFanuc: O word; 0: none is written

  // Robot languages.
  std::string program_name;  ///< empty: from the name of the CL file
  /// What the controller shows, in degrees, for axis J1, J2, ... where its joint is at zero.
  std::array<double, kRobotAxes> zero_deg{};
  /// The controller counts J3 from the horizontal: its J3 is the sum of joints two and three.
  bool is_forearm_coupled = false;
};

/// Why a program is not written: the line of the CL file (0: the whole) and a sentence.
struct PostError {
  std::uint32_t line = 0;
  std::string message;
};

}  // namespace meridian::post
