// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/simulated_drives.hpp"

#include <optional>
#include <string>
#include <vector>

#include "meridian/kinematics/limited.hpp"
#include "service/drives/kit/actions/action_link.hpp"
#include "service/drives/kit/actions/action_words.hpp"
#include "service/drives/kit/intake.hpp"
#include "service/drives/kit/pace.hpp"
#include "service/drives/kit/state_report.hpp"
#include "service/drives/simulated/action_peer.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/writer.hpp"

namespace meridian::drives {

namespace {

constexpr int kDrivePriority = 65;

[[nodiscard]] std::vector<std::string> drive_names(const MachineModel& model) {
  std::vector<std::string> names;
  for (int i = 0; i < model.joint_count; ++i) names.push_back(drive_spec(model, i).name);
  return names;
}

/// The simulated PLC on the wire.
class SimulatedPlc {
 public:
  SimulatedPlc(dds::Participant& participant, const SimulatedDrivesOptions& options)
      : peer_(options.action_delay_ns, options.is_refusing_actions), link_(participant) {}

  void work(std::int64_t now_ns, const std::function<void(const std::string&)>& say) {
    while (link_.take(action_)) {
      ++actions_;
      say("action " + std::to_string(action_.id) + ", line " + std::to_string(action_.line) + ": " +
          drive::describe(action_));
      peer_.take(action_, now_ns);
    }
    while (const auto done = peer_.due_answer(now_ns)) link_.answer(*done);
  }
  [[nodiscard]] std::uint64_t actions() const noexcept { return actions_; }

 private:
  ActionPeer peer_;
  drive::ActionLink link_;
  dds::Action action_;
  std::uint64_t actions_ = 0;
};

}  // namespace

bool prepare_drive_priority() {
  drive::keep_off_last_processor();
  return drive::may_have_priority(kDrivePriority);
}

SimulatedDrivesReport run_simulated_drives(dds::Participant& participant, const MachineModel& model,
                                           const SimulatedDrivesOptions& options,
                                           const std::atomic<bool>& is_stopping,
                                           const std::function<void(const std::string&)>& say) {
  DriveGroup group(model, options.lag, options.homing);
  for (const Injection& injection : options.injections) group.inject(injection);
  if (options.probed) group.connect(SimulatedProbe(*options.probed, model));
  drive::StateReport states(drive_names(model), say);
  dds::Writer<dds::DriveFeedback> feedbacks(participant);
  drive::Intake intake(participant, say);
  std::optional<SimulatedPlc> actions;
  if (options.is_action_peer) actions.emplace(participant, options);
  feedbacks.register_instance(group.feedback());

  SimulatedDrivesReport report;
  dds::DriveFeedback feedback;
  const drive::RaisedPriority raised(options.has_priority ? kDrivePriority : 0);
  drive::Pace pace(model.cycle_ns);
  while (!is_stopping.load(std::memory_order_relaxed)) {
    const int lost = pace.sleep();
    intake.look(pace.now_ns());
    intake.receive(group);
    Injection injection;
    while (options.injections_now != nullptr && options.injections_now->try_pop(injection)) {
      group.inject_now(injection);
    }
    group.work(lost + 1);
    while (group.reports(feedback)) static_cast<void>(feedbacks.write(feedback));
    for (int i = 0; i < group.size(); ++i) {
      states.look(static_cast<std::size_t>(i), group.drive(i).state(), group.drive(i).error());
    }
    if (actions) actions->work(pace.now_ns(), say);
    ++report.periods;
    report.periods_lost += static_cast<std::uint64_t>(lost);
  }
  report.setpoints_seen = group.setpoints_seen();
  report.dropped = group.dropped();
  intake.add_dropped(report.dropped);
  report.periods_bridged = group.periods_bridged();
  if (actions) report.actions = actions->actions();
  return report;
}

}  // namespace meridian::drives
