// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/path_piece.hpp"
#include "service/programs/post/axis_words.hpp"

namespace meridian::post {

/// How a controller moves between two blocks.
enum class BlockMotion : std::uint8_t {
  kDrives,        ///< every drive evenly
  kTipAndRotary,  ///< tip straight, rotary joints evenly
  kTipAndAxis     ///< tip straight, tool axis on the great circle
};

/// How far the motion between two blocks may leave the CL path. Units: mm, rad.
struct PathTolerance {
  double chord_mm = 0.01;
  double axis_rad = 0.0017;
};

/// Where an NC block ends: the drives as the words say them, windings included; share of the piece.
struct BlockEnd {
  double share = 0;
  JointVector axes{};
};

/// Cuts `piece`, which begins at `begin` (drives as written), into NC blocks, as few as a search by
/// halves and doubles finds, and gives the end of each to `take`.
///
/// Between two ends the controller's motion is compared with the CL path at kPlaces places by
/// forward kinematics, and what can lie between the points is bounded: there the deviation e obeys
/// |e| <= max at the points + |e''|/(8 n²), and |e''| <= Ω² ρ + 2 Ω L + what joints and path bend,
/// with Ω the turn of all rotary joints, L the way of all linear ones, ρ the largest distance of
/// the tip from a rotary axis (docs/postprocessor.md). Rounded words are what is compared.
///
/// `is_short_enough(from, to)` may refuse a step for other reasons. False where the tolerance
/// cannot be kept: it is finer than the decimals of the words. Proof: tests/property/post.
class Subdivider {
 public:
  using Check = std::function<bool(const BlockEnd& from, const BlockEnd& to)>;
  using Take = std::function<void(const BlockEnd& to)>;

  Subdivider(const MachineModel& model, const AxisWords& words, BlockMotion motion,
             PathTolerance tolerance)
      : model_(model), words_(words), motion_(motion), tolerance_(tolerance) {}

  [[nodiscard]] bool cut(const PathPiece& piece, const JointVector& begin,
                         const Check& is_short_enough, const Take& take) const;

 private:
  static constexpr int kSamples = 8;

  /// A point on the piece with what the bound needs to know there.
  struct Sample {
    BlockEnd end;
    JointVector exact{};  ///< not rounded: reference of the next
    double reach = 0;     ///< largest distance of the tip from a rotary axis
    bool is_reachable = true;
  };

  [[nodiscard]] Sample sample_at(const PathPiece& piece, double share,
                                 const JointVector& reference) const;
  [[nodiscard]] bool keeps(const PathPiece& piece, const Sample& from, const Sample& to) const;

  const MachineModel& model_;
  const AxisWords& words_;
  BlockMotion motion_;
  PathTolerance tolerance_;
};

}  // namespace meridian::post
