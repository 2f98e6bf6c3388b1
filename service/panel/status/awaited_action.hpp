// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "service/transport/convert/messages.hpp"

namespace meridian::panel {

/// What the path of a machine waits for: one action at a time. An action that is asked for again
/// has a number of its own and takes the place of the one before. One thread.
/// Proof: tests/panel/awaited_action_test.cpp.
class AwaitedAction {
 public:
  /// Somebody is asked for something.
  void ask(const dds::Action& action);
  /// Somebody has answered; returns the action where it is the awaited one, which it then is no
  /// more.
  std::optional<dds::Action> answer(const dds::ActionDone& done);
  /// What the machine says: a program that ended, was aborted or came to a fault waits for nobody,
  /// and a program stop ends where the machine goes on.
  void follow(const dds::Status& status);

  /// Nothing: the path waits for nothing.
  [[nodiscard]] const std::optional<dds::Action>& now() const noexcept { return action_; }

 private:
  std::optional<dds::Action> action_;
  bool has_held_ = false;  ///< the machine was at rest since it was asked
};

}  // namespace meridian::panel
