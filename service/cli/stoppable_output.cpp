// SPDX-License-Identifier: Apache-2.0
#include "service/cli/stoppable_output.hpp"

#include <unistd.h>

#include <chrono>
#include <string>

#include "service/cli/options/peer_options.hpp"

namespace meridian::cli {

StoppableOutput::StoppableOutput() : output_(STDOUT_FILENO) {}

void StoppableOutput::print(std::string_view text) {
  constexpr std::chrono::milliseconds kBetweenLooks{100};
  const std::string line = std::string(text) + '\n';
  while (output_.try_write(line) == text::LineOutput::Result::kNoRoom) {
    if (stop_flag().load()) return;
    output_.wait(kBetweenLooks);
  }
}

}  // namespace meridian::cli
