// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "meridian/interpolator.hpp"
#include "meridian/machine_file.hpp"
#include "two_lines.hpp"

/// embed MACHINE: runs a program on ideal drives (docs/embed.md).
int main(int count, char** arguments) {
  const auto machine = meridian::load_machine(count > 1 ? arguments[1] : "lai.toml");
  if (!machine) return std::puts(machine.error().c_str());
  meridian::Interpolator interpolator{*machine};
  for (const meridian::ClBlock& block : two_lines()) {
    if (const auto pushed = interpolator.push(block); !pushed)
      return std::puts(pushed.error().c_str());
  }
  interpolator.start();
  meridian::Feedback feedback = meridian::ideal_feedback(*machine);
  meridian::Setpoint setpoint;
  while (interpolator.update(feedback, setpoint) == meridian::Status::kRunning) {
    feedback = meridian::ideal_feedback(*machine, setpoint);  // your drives here
  }
  std::printf("cycle %llu, line %u\n", static_cast<unsigned long long>(setpoint.cycle),
              setpoint.line);
}
