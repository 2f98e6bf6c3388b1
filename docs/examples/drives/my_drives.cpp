// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "meridian/drive.hpp"
using namespace meridian::drive;

struct Motors : Hardware {
  double position[6] = {};  // your encoders
  Reading read(int axis) noexcept override { return {.position = position[axis]}; }
  void write(int axis, const Output& output) noexcept override {
    if (output.is_on) position[axis] = output.position;  // your motors
  }
};
std::string act(const Action& action) {  // your spindle, coolant and tool changer
  return std::puts(action.words.c_str()) < 0 ? "nobody reads" : "";
}
std::atomic<bool> is_stopping{false};

/// my_drives MACHINE [DOMAIN]: drives whose motors stand at once where they are commanded.
int main(int count, char** arguments) try {
  for (int end : {SIGINT, SIGTERM}) std::signal(end, [](int) { is_stopping = true; });
  Motors motors;
  Options options{.machine_file = count > 1 ? arguments[1] : "lai.toml", .act = act};
  options.domain = count > 2 ? std::atoi(arguments[2]) : 0;
  Drives(options, motors).run(is_stopping);
} catch (const DriveError& error) {
  return std::puts(error.what()), 1;
}
