// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <mutex>
#include <optional>
#include <semaphore>
#include <thread>

#include "meridian/drive.hpp"
#include "service/drives/kit/actions/action_thread.hpp"
#include "service/drives/kit/group.hpp"
#include "service/drives/kit/intake.hpp"
#include "service/drives/kit/line_reporter.hpp"
#include "service/drives/kit/machine_axes.hpp"
#include "service/drives/kit/other_source.hpp"
#include "service/drives/kit/pace.hpp"
#include "service/drives/kit/state_report.hpp"
#include "service/transport/writer.hpp"

namespace meridian::drive {
namespace {

[[nodiscard]] dds::ParticipantOptions participant_of(const Options& options) {
  return {.domain = options.domain,
          .machine = options.machine,
          .transport = may_have_priority(options.priority) ? dds::Transport::kLoopbackRealtime
                                                           : dds::Transport::kLoopback,
          .open_network =
              options.may_leave_host ? dds::OpenNetwork::kAllowed : dds::OpenNetwork::kRefused};
}

[[nodiscard]] std::vector<std::string> names_of(const Options& options) {
  std::vector<std::string> names;
  for (const Axis& axis : options.axes) names.push_back(axis.name);
  return names;
}

void refuse_beside_others(dds::Participant& participant, const Options& options) {
  constexpr auto kWindow = std::chrono::milliseconds(400);  // for finding one another
  std::uint32_t mask = 0;
  for (const Axis& axis : options.axes) mask |= 1U << static_cast<unsigned>(axis.joint);
  const auto other = find_other_source(participant, mask, kWindow);
  if (!other) return;
  std::string names;
  for (const Axis& axis : options.axes) {
    if ((other->joint_mask >> static_cast<unsigned>(axis.joint) & 1U) == 0) continue;
    names += (names.empty() ? "" : ", ") + axis.name;
  }
  throw DriveError(names + " of machine " + options.machine + " are reported by " + other->name +
                   " already (drive group " + std::to_string(other->group) +
                   "); end that one first");
}

}  // namespace

struct Drives::Impl {
  Impl(const Options& asked, Hardware& motors)
      : options(complete(asked)),
        lines([this](const std::string& text) {
          if (options.report) options.report(text);
        }),
        report([this](const std::string& text) {
          const std::lock_guard lock(reporting);
          lines.write_line(text);
        }),
        hardware(motors),
        participant(participant_of(options)),
        group(group_of(options, motors)),
        intake(participant, report),
        feedbacks(participant),
        states(names_of(options), report) {
    group.see(hardware);
    feedbacks.register_instance(group.feedback());
    if (!options.is_beside_others) refuse_beside_others(participant, options);
    if (options.act) actions.emplace(participant, options.act, report);
    sender = std::jthread([this](const std::stop_token& stop) { send_all(stop); });
  }
  ~Impl() {
    sender.request_stop();
    sent.release();
  }

  void work(int periods) noexcept;
  /// The library's thread: sends what was reported and asks DDS who is there.
  void send_all(const std::stop_token& stop);
  void report_states(const dds::DriveFeedback& feedback);

  Options options;
  LineReporter lines;    ///< whoever reads the news stops no thread that sends
  std::mutex reporting;  ///< two threads have news
  Intake::Report report;
  Hardware& hardware;
  dds::Participant participant;
  Group group;
  Intake intake;
  dds::Writer<dds::DriveFeedback> feedbacks;
  StateReport states;
  SpscRing<dds::DriveFeedback, 64> outgoing;
  std::counting_semaphore<> sent{0};  ///< something is in `outgoing`
  Counts counts;
  std::optional<ActionThread> actions;
  std::jthread sender;  ///< last: it uses the others
};

void Drives::Impl::work(int periods) noexcept {
  intake.receive(group);
  group.work(periods, hardware);
  if (!outgoing.try_push(group.feedback())) ++counts.reports_lost;
  sent.release();
  ++counts.periods;
  counts.periods_lost += static_cast<std::uint64_t>(periods - 1);
}

void Drives::Impl::send_all(const std::stop_token& stop) {
  constexpr auto kLonger = std::chrono::milliseconds(10);
  const RaisedPriority raised(options.priority);
  dds::DriveFeedback feedback;
  while (!stop.stop_requested()) {
    (void)sent.try_acquire_for(kLonger);
    while (outgoing.try_pop(feedback)) {
      (void)feedbacks.write(feedback);
      report_states(feedback);
    }
    intake.look(monotonic_ns());
  }
}

void Drives::Impl::report_states(const dds::DriveFeedback& feedback) {
  for (std::size_t i = 0; i < options.axes.size(); ++i) {
    const auto joint = static_cast<std::size_t>(options.axes[i].joint);
    states.look(i, drive_state(feedback.statusword[joint]), feedback.error[joint]);
  }
}

Drives::Drives(const Options& options, Hardware& hardware) try
    : impl_(std::make_unique<Impl>(options, hardware)) {
} catch (const dds::DdsError& error) {
  throw DriveError(error.what());
}

Drives::~Drives() = default;

void Drives::work(int periods) noexcept { impl_->work(periods > 1 ? periods : 1); }

void Drives::run(const std::atomic<bool>& is_stopping) noexcept {
  run([&] { return is_stopping.load(std::memory_order_relaxed); });
}

void Drives::run(const std::function<bool()>& is_stopping) noexcept {
  const RaisedPriority raised(impl_->options.priority);
  Pace pace(impl_->options.cycle_ns);
  while (!is_stopping()) work(pace.sleep() + 1);
}

int Drives::axis_count() const noexcept { return impl_->group.size(); }

const Axis& Drives::axis(int index) const noexcept {
  return impl_->options.axes[static_cast<std::size_t>(index)];
}

std::int64_t Drives::cycle_ns() const noexcept { return impl_->options.cycle_ns; }

AxisStatus Drives::status(int axis) const noexcept {
  const FollowingAxis& one = impl_->group.axis(axis);
  return {one.statusword(), one.error(),           name_of(one.state()),
          one.position(),   one.following_error(), one.is_referenced()};
}

Counts Drives::counts() const noexcept {
  Counts counts = impl_->counts;
  counts.periods_bridged = impl_->group.periods_bridged();
  counts.setpoints = impl_->group.setpoints_seen();
  DropCounts dropped = impl_->group.dropped();
  impl_->intake.add_dropped(dropped);
  for (std::size_t i = 1; i < kDropKinds; ++i) counts.dropped += dropped[static_cast<Drop>(i)];
  return counts;
}

std::vector<Axis> axes_of(const std::string& machine_file) {
  return axes_of_model(load_model(machine_file));
}

void leave_last_processor() noexcept { keep_off_last_processor(); }

}  // namespace meridian::drive
