// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/path_piece.hpp"
#include "meridian/planner/time_piece.hpp"
#include "service/analysis/certify/enclosed_law.hpp"
#include "service/analysis/certify/enclosed_motion.hpp"

namespace meridian::certify {

/// What has a limit: the first three of every joint and drive, by order of the derivative.
enum class Quantity : std::uint8_t { kVelocity, kAcceleration, kJerk, kFeed };
inline constexpr std::size_t kQuantities = 4;

enum class Status : std::uint8_t {
  kCertified,  ///< no instant of the piece is over a limit
  kUndecided,  ///< neither shown nor refuted within the work that a piece may cost
  kRefuted     ///< an instant is over a limit
};

/// A share of a limit, and whose at what time in its piece. `joint` as in limited.hpp; -1: the tip.
struct Share {
  double share = 0;
  Quantity quantity = Quantity::kVelocity;
  int joint = -1;
  double time_s = 0;
};

/// What is known of a piece. Bounds are of the largest share of a limit that is used anywhere on
/// it: not above `bound`, at least `attained`.
struct PieceVerdict {
  Status status = Status::kCertified;
  Share worst;  ///< kUndecided: a bound that could not be brought down; kRefuted: a share attained
  std::array<Share, kQuantities> bound, attained;
  std::array<std::array<double, 3>, kMaxLimited> joint_bound{};
  EnclosedMotion begin, end;
  std::uint64_t stretches = 0;  ///< that were looked at
};

/// Proves that one time piece keeps velocity, acceleration and jerk of all joints and drives and
/// the feed over the whole of it, or finds an instant that does not.
///
/// Over a stretch of half-width h about its middle m, with Taylor coefficients at m and, of the
/// highest order, all over the stretch,
///
///     f⁽ᵈ⁾(m + δ) = Σ_{i<N} i!/(i-d)! c_i(m) δⁱ⁻ᵈ + N!/(N-d)! c_N(ξ) δᴺ⁻ᵈ     |δ| <= h
///
/// bounds every derivative; a stretch whose bound is above a limit is halved. Source:
/// docs/motion.md, section 12. Proof: tests/unit/certify/piece_check_test.cpp.
class PieceCheck {
 public:
  explicit PieceCheck(const MachineModel& model) : model_(model) {}

  /// A piece that moves, on its path.
  [[nodiscard]] PieceVerdict check(const TimePiece& piece, const PathPiece& path);

 private:
  struct Stretch {
    double from = 0, to = 0;
    int depth = 0;
  };
  struct Trial;

  [[nodiscard]] EnclosedMotion enclose_at(const PathPiece& path, const EnclosedLaw& law,
                                          const EnclosedState& state, bool has_feed) const;
  void look_at(const Stretch& stretch, Trial& trial);
  void weigh(const EnclosedMotion& centre, const EnclosedMotion& all, double reach, double time_s,
             Trial& trial) const;
  void attain(const EnclosedMotion& at, double time_s, Trial& trial) const;
  void find_peak(const TimePiece& piece, Trial& trial) const;

  const MachineModel& model_;
  std::array<double, kQuantities> known_{};  ///< attained by any piece so far
};

}  // namespace meridian::certify
