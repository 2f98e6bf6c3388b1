// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>
#include <thread>

#include "meridian/drive_action.hpp"
#include "service/drives/kit/actions/action_link.hpp"
#include "service/drives/kit/intake.hpp"

namespace meridian::drive {

/// Does the actions of a service one after the other, on a thread of its own, by the integrator's
/// Act, and answers. An Act that throws has refused. Proof: tests/unit/drive_kit/drives_test.cpp.
class ActionThread {
 public:
  ActionThread(dds::Participant& participant, const Act& act, const Intake::Report& report);

 private:
  void run(const std::stop_token& stop);
  [[nodiscard]] std::string do_it(const Action& action) const;

  const Act& act_;
  const Intake::Report& report_;
  ActionLink link_;
  std::jthread thread_;  ///< last: it uses the others
};

}  // namespace meridian::drive
