// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "meridian/kinematics/machine_model.hpp"

namespace meridian::test {

/// `machine` with a keep-out box: `joints` has a bit for each joint of it.
[[nodiscard]] inline MachineModel with_keep_out(MachineModel machine, std::uint32_t joints,
                                                const JointVector& min, const JointVector& max) {
  KeepOutBox box;
  box.joints = joints;
  box.min = min;
  box.max = max;
  EXPECT_TRUE(machine.keep_out.add(box));
  return machine;
}

}  // namespace meridian::test
