// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "meridian/path/cl_block.hpp"
#include "service/programs/proof/joint_program.hpp"

namespace meridian::proof {

/// The moves of an NC program with tool-centre control, as service/programs/nc reads them: the tip
/// goes straight, or on arcs cut into chords within 1e-5 mm; the axis on the great circle, or, with
/// rotary words, through forward kinematics of evenly turning joints, in the pieces that the reader
/// cuts. Context: I/O. Proof: tests/unit/proof/tip_program_test.cpp.
[[nodiscard]] std::vector<ProgramStep> steps_of_tip(const std::vector<ClBlock>& program);

/// How much finer than the machine's own tolerance the reader of a program that is checked cuts
/// blocks whose rotary joints turn evenly.
inline constexpr double kFinerTurns = 1.0 / 64;

}  // namespace meridian::proof
