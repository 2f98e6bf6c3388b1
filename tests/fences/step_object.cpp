// SPDX-License-Identifier: Apache-2.0

/// The object file that holds all of step(): the symbol fence looks at what it leaves undefined.

#include "meridian/cycle/step.hpp"

extern "C" void meridian_fence_root(const meridian::MachineModel& model,
                                    meridian::CycleState& state, meridian::MotionReader& motion,
                                    const meridian::CycleInputs& inputs,
                                    meridian::StepOutput& output) noexcept {
  meridian::step(model, state, motion, inputs, output);
}
