// SPDX-License-Identifier: Apache-2.0
#include "service/cli/injection_console.hpp"

#include <poll.h>
#include <unistd.h>

#include <cstdio>

namespace meridian::cli {

void InjectionConsole::run() {
  constexpr int kLookForStop_ms = 100;
  std::string line;
  pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  while (!is_stopping_) {
    if (::poll(&input, 1, kLookForStop_ms) <= 0) continue;
    char c = 0;
    if (::read(STDIN_FILENO, &c, 1) <= 0) return;
    if (c != '\n') {
      line += c;
      continue;
    }
    if (!line.empty()) take(line);
    line.clear();
  }
}

void InjectionConsole::take(const std::string& line) {
  const auto injection = drives::parse_injection(line, model_);
  if (!injection) {
    std::fprintf(stderr, "%s\n", injection.error().c_str());
  } else if (line.find('@') != std::string::npos) {
    std::fprintf(stderr, "'%s': here it happens at once; @SECONDS is for --inject\n", line.c_str());
  } else if (!injections_.try_push(*injection)) {
    std::fprintf(stderr, "'%s': too many at once\n", line.c_str());
  } else {
    std::printf("injected: %s\n", line.c_str());
    std::fflush(stdout);
  }
}

}  // namespace meridian::cli
