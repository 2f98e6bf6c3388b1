// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"

namespace meridian::proof {

/// Why a program is not read, or fails: the line of the program (0: the whole) and a sentence.
struct ProgramError {
  std::uint32_t line = 0;
  std::string message;
};

/// What one line of a joint program does.
struct ProgramStep {
  enum class Kind : std::uint8_t {
    kRapid,  ///< G0
    kCut,    ///< G1
    kAway,   ///< a block of the machine's own: nobody knows where `unknown` joints are then
    kTool,   ///< Tn M6
    kEnd     ///< M30
  };
  Kind kind{};
  std::uint32_t line = 0;
  int tool = 0;            ///< kTool
  JointVector drives{};    ///< where the line ends, mm or rad, in drive order
  bool is_placed = false;  ///< every drive's position is known
  /// Of a program with tool-centre control: tip and axis where the line ends, in place of drives.
  std::optional<ToolPose> tool_pose = std::nullopt;
};

/// A program of joint words: RS-274 with the axis letters of `model`.
///
/// Strict: it reads G0, G1, G4, G17, G21, G40, G49, G54 to G59, G80, G90, G93, G94, the M words of
/// spindle, coolant, stops and tool, N, S, T, F, P and the machine's axis words; G28 and G53 take
/// axes to places that it does not know. Everything else is refused with its line: an axis letter
/// that the machine has not, two words of one letter, a cut without a feed, motion before the mode
/// is known, a word twice, a program without end. Units come out as mm and rad. Context: I/O.
/// Proof: tests/unit/proof.
[[nodiscard]] Expected<std::vector<ProgramStep>, ProgramError> read_joint_program(
    std::istream& in, const MachineModel& model);

/// Whether `head`, the beginning of a file, is an NC program rather than a recording: its first
/// character is %, (, ;, or a word with a number.
[[nodiscard]] bool is_nc_program(const std::string& head);

}  // namespace meridian::proof
