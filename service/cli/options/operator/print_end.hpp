// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

#include "service/cli/commands.hpp"

/// How a word of `ctl` that ended badly says so, on standard error.
namespace meridian::cli {

/// What went wrong; returns `exit_code`.
[[nodiscard]] inline int print_failure(const std::string& what, int exit_code) {
  std::fprintf(stderr, "meridian: %s\n", what.c_str());
  return exit_code;
}

/// Why nothing is done; returns kMachineRefused.
[[nodiscard]] inline int print_refusal(const std::string& why) {
  std::fprintf(stderr, "refused: %s\n", why.c_str());
  return kMachineRefused;
}

/// Nobody answers any more, in the middle of a motion; returns kNoPeer.
[[nodiscard]] inline int print_silence() {
  return print_failure("the machine does not answer: look what it does", kNoPeer);
}

}  // namespace meridian::cli
