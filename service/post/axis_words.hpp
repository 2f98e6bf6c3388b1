// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "meridian/expected.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/post/post_options.hpp"

namespace meridian::post {

inline constexpr int kLinearDecimals = 4;  ///< of a millimetre
inline constexpr int kRotaryDecimals = 5;  ///< of a degree: 0.09 µm at 1 m

/// The words of a machine's joints: by which address a program calls each, and which way it counts.
///
/// An address is the joint's `nc_word` in the machine file, or its name where that is one of the
/// letters X Y Z A B C U V W. Nothing else is guessed. An address with digits is written with `=`.
class AxisWords {
 public:
  [[nodiscard]] static Expected<AxisWords, PostError> of(const MachineModel& model);

  /// Joint that is called `address`; -1 where none is.
  [[nodiscard]] int find(std::string_view address) const noexcept;

  /// What the word of joint `i` says for the joint at `q` (mm or rad): mm or deg, as rounded as it
  /// is written.
  [[nodiscard]] double value(int i, double q) const;
  /// The joint at which the word says `value()`.
  [[nodiscard]] double joint(int i, double value) const noexcept;
  /// `q` as the words say it.
  [[nodiscard]] JointVector as_written(const JointVector& q) const;

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
/// per joint at home. 0 where the machine has no linear Z along the tool axis of its home.
[[nodiscard]] int retract_sense(const MachineModel& model, const AxisWords& words);

}  // namespace meridian::post
