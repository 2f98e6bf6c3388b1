// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <string>

namespace meridian::test {

struct CommandOutput {
  int exit_code = -1;
  std::string output;
};

/// Runs a line of the shell to its end.
[[nodiscard]] inline CommandOutput run_command(const std::string& command) {
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  std::string output;
  char buffer[4096];
  while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) output.append(buffer, n);
  return {WEXITSTATUS(pclose(pipe)), output};
}

/// Runs the built tool with `arguments` on what `input` prints; standard output and error together.
[[nodiscard]] inline CommandOutput run_tool(const std::string& arguments,
                                            const std::string& input = "true") {
  return run_command(input + " | " + MERIDIAN_BINARY_DIR + "/bin/meridian " + arguments + " 2>&1");
}

}  // namespace meridian::test
