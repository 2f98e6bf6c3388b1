// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "service/text/line_output.hpp"

namespace meridian::cli {

/// Standard output of a command that runs until it is stopped (watch_for_stop()): it waits for who
/// reads, but not beyond the stop: a pipe that nobody empties keeps no command alive. One thread.
class StoppableOutput {
 public:
  StoppableOutput();
  /// Prints `text` and a newline. After the stop what finds no room is left out.
  void print(std::string_view text);

 private:
  text::LineOutput output_;
};

}  // namespace meridian::cli
