// SPDX-License-Identifier: Apache-2.0
#include "service/cli/record_live.hpp"

#include <chrono>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <memory>
#include <optional>
#include <thread>

#include "meridian/cycle/spsc_ring.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/cli/commands.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/neighbours/ros/wire_file.hpp"
#include "service/protocol/operator/served_model.hpp"
#include "service/protocol/station/end_watch.hpp"
#include "service/protocol/steady_ns.hpp"
#include "service/recording/record/file/wire_recording.hpp"
#include "service/transport/followed.hpp"
#include "service/transport/reader.hpp"

namespace meridian::cli {
namespace {

/// The names and units of the drives, and the cycle: all that a recording of the wire needs.
[[nodiscard]] MachineModel model_of(const dds::MachineInfo& machine) {
  MachineModel model;
  model.name = machine.name;
  model.cycle_ns = machine.cycle_ns;
  model.joint_count = static_cast<int>(machine.joint_count);
  for (std::uint32_t i = 0; i < machine.joint_count; ++i) {
    model.joints[i].name = machine.joints[i].name;
    model.joints[i].is_rotary = machine.joints[i].is_rotary;
  }
  for (std::uint32_t i = 0; i < machine.stage_drive_count; ++i) {
    const dds::JointInfo& drive = machine.stage_drives[i];
    if (drive.drive >= machine.joint_count) continue;
    model.joints[drive.drive].name = drive.name;
    model.joints[drive.drive].is_rotary = drive.is_rotary;
  }
  return model;
}

/// Whether a whole machine has the drives, and the cycle, of the one on the wire.
[[nodiscard]] bool is_same(const MachineModel& wire, const MachineModel& whole) {
  bool is_same = wire.joint_count == whole.joint_count && wire.cycle_ns == whole.cycle_ns;
  for (int i = 0; is_same && i < wire.joint_count; ++i) {
    const JointSpec& drive = drive_spec(whole, i);
    is_same = wire.joints[i].name == drive.name && wire.joints[i].is_rotary == drive.is_rotary;
  }
  return is_same;
}

template <class Message>
struct Arrived {
  Message message;
  std::int64_t arrival_ns = 0;
};

/// Takes samples on the receive thread, with the time of their arrival.
template <class Message>
class Tap {
 public:
  explicit Tap(dds::Participant& participant)
      : reader_(
            participant,
            [this](dds::Reader<Message>& reader) {
              Arrived<Message> arrived;
              while (reader.take(arrived.message)) {
                arrived.arrival_ns = stream::steady_ns();
                if (!ring_.try_push(arrived)) overrun_.fetch_add(1, std::memory_order_relaxed);
              }
            },
            kDepth) {}

  [[nodiscard]] const Arrived<Message>* next() { return ring_.peek(0); }
  void pop() { ring_.drop(1); }
  [[nodiscard]] std::uint64_t overrun() const { return overrun_.load(); }

 private:
  static constexpr int kDepth = 64;  ///< that wait while a sample is taken
  SpscRing<Arrived<Message>, 8192> ring_;
  std::atomic<std::uint64_t> overrun_{0};
  dds::Reader<Message> reader_;
};

/// What the groups of drives said, put together.
class Feedbacks {
 public:
  void take(const Arrived<dds::DriveFeedback>& arrived, record::WireRow& row) {
    const dds::DriveFeedback& feedback = arrived.message;
    row.feedback_cycle = feedback.cycle_seen;
    row.feedback_ns = arrived.arrival_ns;
    for (std::size_t i = 0; i < row.feedback.size(); ++i) {
      if ((feedback.joint_mask >> i & 1U) == 0) continue;
      row.feedback[i] = feedback.position[i];
      row.statusword[i] = feedback.statusword[i];
      row.drive_error[i] = feedback.error[i];
    }
    const std::uint32_t group = 1U << (feedback.drive_group % 32U);
    stopped_ = feedback.is_emergency_stop ? stopped_ | group : stopped_ & ~group;
    row.is_emergency_stop = stopped_ != 0;
  }

 private:
  std::uint32_t stopped_ = 0;  ///< groups that report the emergency stop
};

/// The files that are wanted: CSV, MCAP, or both.
class Files {
 public:
  /// An error where one cannot be made. `wire`: the drives' names; `served`: the whole machine.
  [[nodiscard]] std::optional<record::RecordError> open(const LiveOptions& options,
                                                        const MachineModel& wire,
                                                        const MachineModel& served) {
    if (!options.output.empty()) {
      auto csv = record::WireWriter::create(options.output, wire);
      if (!csv) return csv.error();
      csv_.emplace(std::move(*csv));
      csv_path_ = options.output;
    }
    if (!options.mcap.empty()) {
      auto mcap = ros::WireFile::create(options.mcap, served);
      if (!mcap) return mcap.error();
      mcap_ = std::move(*mcap);
    }
    return std::nullopt;
  }
  void add(const record::WireRow& row) {
    if (csv_) (void)csv_->write(row);
    if (mcap_) mcap_->add(row);
  }
  void report(const dds::Status& status) {
    if (mcap_) mcap_->add_status(status.state, status.alarm, status.alarm_joint);
  }
  /// What was lost.
  [[nodiscard]] std::optional<record::RecordError> close() {
    std::optional<record::RecordError> lost;
    if (mcap_) lost = mcap_->close();
    if (csv_ && !csv_->close()) {
      lost = record::RecordError{csv_path_, 0, std::strerror(csv_->error_number()), ""};
    }
    return lost;
  }

 private:
  std::optional<record::WireWriter> csv_;
  std::string csv_path_;
  std::unique_ptr<ros::WireFile> mcap_;
};

/// The machine with its kinematics, for an MCAP file: of the file after --machine, else of the one
/// that the service publishes. Throws config::ConfigError.
[[nodiscard]] MachineModel whole_model(const LiveOptions& options, const dds::MachineInfo& info) {
  if (options.mcap.empty()) return {};
  if (!options.machine.machine.empty()) return load_machine(options.machine);
  if (!info.machine_file.empty()) return stream::served_model(info);
  throw config::ConfigError(
      {.file = info.name,
       .value = "its service does not publish the machine file, which is long",
       .remedy = "name the file after --machine"});
}

int refuse(const record::RecordError& error) {
  std::cerr << error.text() << "\n";
  return kInputRefused;
}

}  // namespace

int record_live(LiveOptions& options) {
  int exit_code = kFine;
  const auto machine = find_machine(options.peer, exit_code);
  if (!machine) return exit_code;
  const MachineModel model = model_of(*machine), served = whole_model(options, *machine);
  if (!options.mcap.empty() && !is_same(model, served)) {
    return refuse({options.machine.machine, 0, "is not the machine '" + machine->name + "'",
                   "name the file that its service runs with, or leave --machine out"});
  }
  Files files;
  if (const auto error = files.open(options, model, served)) return refuse(*error);
  dds::Participant participant({.domain = options.peer.domain, .machine = options.peer.machine});
  const auto setpoints = std::make_unique<Tap<dds::SetpointSample>>(participant);
  const auto feedbacks = std::make_unique<Tap<dds::DriveFeedback>>(participant);
  dds::Reader<dds::Status> statuses(participant);
  dds::Followed<dds::Status> followed;
  dds::Status status;
  stream::EndWatch end;
  record::WireBook book(model);
  record::WireRow row;
  Feedbacks said;
  std::uint64_t service_id = machine->service_id;
  watch_for_stop();
  std::fprintf(stderr, "meridian record: listening to machine %s%s\n", machine->name.c_str(),
               options.until_end ? " until its program ends" : ", Ctrl-C ends");
  const auto begin = std::chrono::steady_clock::now();
  for (bool is_last = false; !is_last;) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    if (followed.take(statuses, status)) {
      end.see(status);
      files.report(status);
      service_id = status.service_id;
    }
    is_last = stop_flag().load() ||
              (options.duration_s > 0 && passed.count() >= options.duration_s) ||
              (options.until_end && end.is_over());
    while (const auto* setpoint = setpoints->next()) {
      for (const auto* feedback = feedbacks->next();
           feedback != nullptr && feedback->arrival_ns <= setpoint->arrival_ns;
           feedback = feedbacks->next()) {
        said.take(*feedback, row);
        feedbacks->pop();
      }
      row.setpoint = setpoint->message.setpoint;
      row.is_intact = setpoint->message.crc == dds::setpoint_crc(row.setpoint, service_id);
      row.arrival_ns = setpoint->arrival_ns;
      setpoints->pop();
      end.see(row.setpoint);
      book.add(row);
      files.add(row);
    }
    if (!is_last) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  std::cout << book.to_text();
  if (setpoints->overrun() > 0) {
    std::cout << "  " << setpoints->overrun() << " setpoints came faster than they were written\n";
  }
  if (const auto lost = files.close()) return refuse(*lost);
  if (book.received() == 0) return kNoPeer;
  const bool is_bad =
      options.max_missing >= 0 && book.missing() > static_cast<std::uint64_t>(options.max_missing);
  return is_bad ? kVerdictNo : kFine;
}

}  // namespace meridian::cli
