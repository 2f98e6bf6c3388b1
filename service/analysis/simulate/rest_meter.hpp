// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace meridian::simulate {

/// What rests cost: the time that setting off from them and coming to them takes beyond what the
/// same length would take at the speed that the one leads to and the other begins with.
///
/// Of speed v along the path, a ramp between a rest and the nearest maximum v_top loses
/// ∫ (1 - v/v_top) dt. Where a block is too short for its feed, v_top is all that it reaches: the
/// rests cost more than that there. Units: s, and any unit of path length.
class RestMeter {
 public:
  /// The motion goes on for `time_s` at `speed`, at least 0, along its path.
  void move(double speed, double time_s);
  /// It rests, or has just set off from a rest that lay between two cycles.
  void rest();

  /// What was lost by the rests up to the last one.
  [[nodiscard]] double lost_s() const { return lost_s_; }

 private:
  /// Time and length since the speed was `top`.
  struct Ramp {
    double time_s = 0, length = 0;
    [[nodiscard]] double loss_s(double top) const { return top > 0 ? time_s - length / top : 0; }
  };

  Ramp ramp_;
  double top_ = 0;        ///< fastest sample of the ramp
  double last_ = 0;       ///< the last one
  bool sets_off_ = true;  ///< the ramp began at a rest
  double lost_s_ = 0;
};

}  // namespace meridian::simulate
