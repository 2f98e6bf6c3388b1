// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "meridian/expected.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/programs/post/post_options.hpp"

namespace meridian::post {

inline constexpr int kLinearDecimals = 4;  ///< of a millimetre
inline constexpr int kRotaryDecimals = 5;  ///< of a degree: 0.09 µm at 1 m

/// The words of a machine's axes: by which address a program calls each, and which way it counts.
/// Axes are the drives in drive order: the joints, or behind a stage its two sliders in the places
/// of the joints that they carry.
///
/// An address is the `nc_word` in the machine file, or the name where that is one of the letters
/// X Y Z A B C U V W. Nothing else is guessed. An address with digits is written with `=`.
class AxisWords {
 public:
  [[nodiscard]] static Expected<AxisWords, PostError> of(const MachineModel& model);

  /// Axis that is called `address`; -1 where none is.
  [[nodiscard]] int find(std::string_view address) const noexcept;

  /// What the word of axis `i` says for the axis at `at` (mm or rad): mm or deg, as rounded as it
  /// is written.
  [[nodiscard]] double value(int i, double at) const;
  /// Where the axis is for which the word says `value()`.
  [[nodiscard]] double axis(int i, double value) const noexcept;
  /// The axes `at` as the words say them.
  [[nodiscard]] JointVector as_written(const JointVector& at) const;

  /// "X12.3000", "A1=-90.00000".
  [[nodiscard]] std::string word(int i, double value) const;

  [[nodiscard]] int count() const noexcept { return count_; }
  [[nodiscard]] bool is_rotary(int i) const noexcept { return axes_[i].is_rotary; }
  [[nodiscard]] int sign(int i) const noexcept { return axes_[i].sign; }
  [[nodiscard]] const std::string& address(int i) const noexcept { return axes_[i].address; }

 private:
  struct Axis {
    std::string address;
    int sign = 1;
    bool is_rotary = false;
  };
  std::array<Axis, kMaxJoints> axes_;
  int count_ = 0;
};

/// Which way joint Z has to go to take the tool off the part: the sign of dz along the tool axis
/// per joint at home. 0 where the machine has no linear Z along the tool axis of its home that
/// moves alone.
[[nodiscard]] int retract_sense(const MachineModel& model, const AxisWords& words);

}  // namespace meridian::post
