// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "meridian/cycle/spsc_ring.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/drives/simulated/injection.hpp"

namespace meridian::cli {

/// Reads injections from standard input, one a line, until it ends or this does. A thread of its
/// own: the drives never wait for it. What it cannot read it says on standard error.
class InjectionConsole {
 public:
  explicit InjectionConsole(const MachineModel& model)
      : model_(model), thread_([this] { run(); }) {}
  ~InjectionConsole() {
    is_stopping_ = true;
    thread_.join();
  }
  InjectionConsole(const InjectionConsole&) = delete;
  InjectionConsole& operator=(const InjectionConsole&) = delete;

  [[nodiscard]] SpscRing<drives::Injection, 64>& injections() noexcept { return injections_; }

 private:
  void run();
  void take(const std::string& line);

  const MachineModel& model_;
  SpscRing<drives::Injection, 64> injections_;
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

}  // namespace meridian::cli
