// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated_drives.hpp"

#include <pthread.h>
#include <sched.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

#include "meridian/kinematics/limited.hpp"
#include "service/dds/messages.hpp"
#include "service/dds/reader.hpp"
#include "service/dds/writer.hpp"
#include "service/drive/intake.hpp"
#include "service/drives/action_peer.hpp"

namespace meridian::drives {

namespace {

constexpr int kDrivePriority = 65;

bool set_priority(int policy, int priority) noexcept {
  const sched_param param{.sched_priority = priority};
  return ::pthread_setschedparam(::pthread_self(), policy, &param) == 0;
}

constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::int64_t monotonic_ns() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond_ns + now.tv_nsec;
}

void sleep_until(std::int64_t due_ns) noexcept {
  const timespec due{due_ns / kSecond_ns, due_ns % kSecond_ns};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) != 0) {
  }
}

/// Says when a drive changed its state.
class StateTeller {
 public:
  StateTeller(const MachineModel& model, const std::function<void(const std::string&)>& say)
      : model_(model), say_(say) {
    seen_.fill(DriveState::kSwitchOnDisabled);
  }

  void look(const DriveGroup& group) {
    for (int i = 0; i < group.size(); ++i) {
      const drive::FollowingAxis& drive = group.drive(i);
      const auto place = static_cast<std::size_t>(i);
      if (seen_[place] == drive.state()) continue;
      seen_[place] = drive.state();
      char error[32] = "";
      if (drive.error() != drive::kErrorNone) {
        std::snprintf(error, sizeof error, " (error %04Xh)", drive.error());
      }
      say_("drive " + drive_spec(model_, i).name + ": " + name_of(drive.state()) + error);
    }
  }

 private:
  const MachineModel& model_;
  const std::function<void(const std::string&)>& say_;
  std::array<DriveState, kMaxJoints> seen_;
};

/// The PLC's end of the wire.
class ActionLink {
 public:
  ActionLink(dds::Participant& participant, const SimulatedDrivesOptions& options)
      : peer_(options.action_delay_ns, options.is_refusing_actions),
        reader_(participant),
        writer_(participant) {}

  void work(std::int64_t now_ns, const std::function<void(const std::string&)>& say) {
    while (reader_.take(action_)) {
      ++actions_;
      say("action " + std::to_string(action_.id) + ", line " + std::to_string(action_.line) + ": " +
          describe(action_));
      peer_.take(action_, now_ns);
    }
    while (const auto done = peer_.due_answer(now_ns)) static_cast<void>(writer_.write(*done));
  }
  [[nodiscard]] std::uint64_t actions() const noexcept { return actions_; }

 private:
  ActionPeer peer_;
  dds::Reader<dds::Action> reader_;
  dds::Writer<dds::ActionDone> writer_;
  dds::Action action_;
  std::uint64_t actions_ = 0;
};

}  // namespace

bool prepare_drive_priority() noexcept {
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  if (::sched_getaffinity(0, sizeof cpus, &cpus) == 0 && CPU_COUNT(&cpus) > 1) {
    int last = 0;
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) last = CPU_ISSET(cpu, &cpus) ? cpu : last;
    CPU_CLR(last, &cpus);
    static_cast<void>(::sched_setaffinity(0, sizeof cpus, &cpus));
  }
  return set_priority(SCHED_FIFO, kDrivePriority) && set_priority(SCHED_OTHER, 0);
}

SimulatedDrivesReport run_simulated_drives(dds::Participant& participant, const MachineModel& model,
                                           const SimulatedDrivesOptions& options,
                                           const std::atomic<bool>& is_stopping,
                                           const std::function<void(const std::string&)>& say) {
  DriveGroup group(model, options.lag, options.homing);
  for (const Injection& injection : options.injections) group.inject(injection);
  StateTeller teller(model, say);
  dds::Writer<dds::DriveFeedback> feedbacks(participant);
  drive::Intake intake(participant, say);
  std::optional<ActionLink> actions;
  if (options.is_action_peer) actions.emplace(participant, options);
  feedbacks.register_instance(group.feedback());

  SimulatedDrivesReport report;
  dds::DriveFeedback feedback;
  if (options.has_priority) static_cast<void>(set_priority(SCHED_FIFO, kDrivePriority));
  std::int64_t due_ns = monotonic_ns();
  while (!is_stopping.load(std::memory_order_relaxed)) {
    due_ns += model.cycle_ns;
    sleep_until(due_ns);
    const std::int64_t now_ns = monotonic_ns();
    const std::int64_t lost = (now_ns - due_ns) / model.cycle_ns;
    due_ns += lost * model.cycle_ns;
    intake.look(now_ns);
    intake.receive(group);
    Injection injection;
    while (options.injections_now != nullptr && options.injections_now->try_pop(injection)) {
      group.inject_now(injection);
    }
    group.work(static_cast<int>(lost) + 1);
    while (group.reports(feedback)) static_cast<void>(feedbacks.write(feedback));
    teller.look(group);
    if (actions) actions->work(now_ns, say);
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
