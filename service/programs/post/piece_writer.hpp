// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "meridian/kinematics/limited.hpp"
#include "service/programs/post/planned_path.hpp"
#include "service/programs/post/program.hpp"
#include "service/programs/post/subdivide.hpp"

namespace meridian::post {

/// Nothing, or why not.
using Refusal = std::optional<PostError>;

/// From the pieces of a block's way to blocks of a program: cut by the tolerance, with the time or
/// the feed that each block takes. It knows where the program stands.
class PieceWriter {
 public:
  /// `program` and what `parts` refers to outlive it.
  PieceWriter(const ProgramParts& parts, const PathTolerance& tolerance, Program& program)
      : parts_(parts),
        tolerance_(tolerance),
        program_(program),
        cutter_(parts.model, parts.words, program.motion(), tolerance) {}

  /// `way` is the length of all pieces of the block, which shares of its time are measured by.
  [[nodiscard]] Refusal write(const PlannedPiece& planned_piece, const ClBlock& block,
                              double block_length);

  /// The controller finds the way over `piece` by itself.
  void skip(const PathPiece& piece) { (void)stand_at(piece.joints_end); }

  /// The program stands at `joints`; returns its drives as the words say them.
  JointVector stand_at(const JointVector& joints) {
    return stands_at_ = parts_.words.as_written(drives_of(parts_.model, joints));
  }

 private:
  /// Straight in the joints: behind a stage, rapids along which drives and joints stay together.
  void write_joint_move(const PathPiece& piece);
  /// Least time from `a` to `b` that joints and drives need.
  [[nodiscard]] double min_time(const JointVector& a, const JointVector& b) const;

  const ProgramParts parts_;
  const PathTolerance tolerance_;
  Program& program_;
  Subdivider cutter_;
  JointVector stands_at_{};  ///< drives
};

}  // namespace meridian::post
