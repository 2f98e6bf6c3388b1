// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/host/process/programs.hpp"
#include "service/host/soak/chaos.hpp"
#include "service/host/soak/plant.hpp"
#include "service/host/soak/report/check.hpp"
#include "service/host/soak/soak.hpp"
#include "service/host/soak/watch/run_watch.hpp"
#include "service/protocol/operator/operator_link.hpp"
#include "service/protocol/steady_ns.hpp"
#include "service/transport/participant.hpp"

namespace meridian::soak {

/// One run: keeps the processes of a plant alive (soak_run.cpp) and is the operator of its machine,
/// who lets mishaps happen (soak_operate.cpp). Times s since its begin.
class SoakRun {
 public:
  /// Options and `say` must stay. `model`: with the bridge of this run.
  SoakRun(const SoakOptions& options, const PlantOptions& plant, MachineModel model,
          const std::function<void(const std::string&)>& say);

  [[nodiscard]] SoakReport run(const std::atomic<bool>& is_stopping);

 private:
  [[nodiscard]] double now_s() const {
    return static_cast<double>(stream::steady_ns() - begin_ns_) * 1e-9;
  }

  void start_service();
  /// New drives; those that ended by themselves stay away for a while first.
  void start_drives();
  /// Starts again what died or was killed.
  void keep_alive();
  [[nodiscard]] std::string next_program();
  void start_program();
  void end_program(int code);
  void lose_station();

  void see(const dds::Status& status);
  /// What the drives suffer of is over with their process.
  void check_fault(FaultCheck::Cause cause, const dds::Status& status);
  [[nodiscard]] std::string keep_evidence();
  void look_and_report();
  void look();
  void report();
  void end();

  void operate(const dds::Status& status);
  /// Asks, and not again at once; whether it was accepted.
  bool ask(Verb verb, double value = 0);
  /// Asks for the way out of Off or Fault. Drives may have fallen ill while nobody could stop in
  /// Fault for it, and a reset, accepted or not, does not mend them: there are new ones then.
  void lead_on(Verb verb);
  /// From anywhere back to a machine that can be switched on.
  void break_off();
  void mishaps();
  /// Lets it happen; false where it was refused or there was nobody for it to happen to.
  bool happen(const Planned& mishap);

  /// A service that is killed is forgotten after its lease; drives that lost it come to rest.
  /// Drives that ended by themselves are gone as long.
  static constexpr double kAfterDeath_s = 2.5;

  const SoakOptions& options_;
  const std::function<void(const std::string&)>& say_;
  const process::ScratchFolder folder_;
  const MachineModel model_;
  const ToolTable tools_;
  SoakReport report_;
  Check check_;
  Plant plant_;
  Chaos chaos_;
  dds::Participant participant_;
  stream::OperatorLink operator_;
  RunWatch watch_;
  std::optional<Planned> next_, injected_;
  State state_ = State::kOff;
  bool is_drive_sick_ = false;
  int asked_in_vain_ = 0;
  const std::int64_t begin_ns_ = stream::steady_ns();
  double moved_s_ = 0, ended_s_ = 0, ask_again_s_ = 0, resume_s_ = 0, continue_s_ = 0;
  double service_at_s_ = 0, drives_at_s_ = 0, flight_at_s_ = 0, healthy_s_ = 0, reported_s_ = 0;
};

}  // namespace meridian::soak
