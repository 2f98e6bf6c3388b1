// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace meridian::post {

/// Which words a program is written in. docs/postprocessor.md has every word of each.
enum class Dialect : std::uint8_t {
  kJoints,     ///< RS-274: joint positions, feed in inverse time; no tool-centre control needed
  kFanuc,      ///< G43.4 with rotary words, or G43.5 with I J K
  kSiemens,    ///< TRAORI with A3= B3= C3=
  kHeidenhain  ///< FUNCTION TCPM and LN with TX TY TZ
};

/// What `meridian post` is told beside program and machine. Units: mm, rad, s.
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
};

/// Why a program is not written: the line of the CL file (0: the whole) and a sentence.
struct PostError {
  std::uint32_t line = 0;
  std::string message;
};

}  // namespace meridian::post
