// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "service/panel/status/awaited_action.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::panel {

/// What the program asked of spindle, coolant and tool changer, and what it waits for, from the
/// actions on the wire and their answers. A panel that begins in the middle of a program does not
/// know what was asked before. One thread. Proof: tests/panel/auxiliaries_test.cpp.
class Auxiliaries {
 public:
  /// Somebody is asked for something.
  void ask(const dds::Action& action) { awaited_.ask(action); }
  /// Somebody has answered.
  void answer(const dds::ActionDone& done);
  /// What the machine says: with its drives off nothing waits, and nothing is known to turn.
  void follow(const dds::Status& status);

  /// "spindle clockwise 8000 rev/min"; empty: not known.
  [[nodiscard]] const std::string& spindle() const noexcept { return spindle_; }
  /// "coolant flood"; empty: not known.
  [[nodiscard]] const std::string& coolant() const noexcept { return coolant_; }
  /// What the path waits for; empty: nothing.
  [[nodiscard]] std::string waits_for() const;

 private:
  AwaitedAction awaited_;
  std::string spindle_, coolant_;
};

}  // namespace meridian::panel
