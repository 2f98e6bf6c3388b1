// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <memory>
#include <thread>

#include "meridian/rt/spsc_ring.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/finite_range.hpp"
#include "service/cli/machine_options.hpp"
#include "service/cli/peer_options.hpp"
#include "service/dds/followed.hpp"
#include "service/dds/reader.hpp"
#include "service/record/flight_picture.hpp"
#include "service/record/flight_report.hpp"
#include "service/record/wire_recording.hpp"
#include "service/ros/conversion.hpp"
#include "service/stream/end_watch.hpp"
#include "service/stream/steady_ns.hpp"

namespace meridian::cli {
namespace {

struct Options {
  std::string output, flight, recording, mcap, picture;
  MachineOptions machine;
  double duration_s = 0;
  bool until_end = false;
  std::int64_t max_missing = -1;
  PeerOptions peer;
};

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

void take_feedback(const dds::DriveFeedback& feedback, record::WireRow& row) {
  row.feedback_cycle = feedback.cycle_seen;
  for (std::size_t i = 0; i < row.feedback.size(); ++i) {
    if ((feedback.joint_mask >> i & 1U) != 0) row.feedback[i] = feedback.position[i];
  }
}

int run(Options& options) {
  int exit_code = kFine;
  const auto machine = find_machine(options.peer, exit_code);
  if (!machine) return exit_code;
  const MachineModel model = model_of(*machine);
  auto writer = record::WireWriter::create(options.output, model);
  if (!writer) {
    std::cerr << writer.error().text() << "\n";
    return kInputRefused;
  }
  dds::Participant participant({.domain = options.peer.domain, .machine = options.peer.machine});
  const auto setpoints = std::make_unique<Tap<dds::SetpointSample>>(participant);
  const auto feedbacks = std::make_unique<Tap<dds::DriveFeedback>>(participant);
  dds::Reader<dds::Status> statuses(participant);
  dds::Followed<dds::Status> followed;
  dds::Status status;
  stream::EndWatch end;
  record::WireBook book(model);
  record::WireRow row;
  std::uint64_t service_id = machine->service_id;
  watch_for_stop();
  std::fprintf(stderr, "meridian record: listening to machine %s%s\n", machine->name.c_str(),
               options.until_end ? " until its program ends" : ", Ctrl-C ends");
  const auto begin = std::chrono::steady_clock::now();
  for (bool is_last = false; !is_last;) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    if (followed.take(statuses, status)) {
      end.see(status);
      service_id = status.service_id;
    }
    is_last = stop_flag().load() ||
              (options.duration_s > 0 && passed.count() >= options.duration_s) ||
              (options.until_end && end.is_over());
    while (const auto* setpoint = setpoints->next()) {
      for (const auto* feedback = feedbacks->next();
           feedback != nullptr && feedback->arrival_ns <= setpoint->arrival_ns;
           feedback = feedbacks->next()) {
        take_feedback(feedback->message, row);
        feedbacks->pop();
      }
      row.setpoint = setpoint->message.setpoint;
      row.is_intact = setpoint->message.crc == dds::setpoint_crc(row.setpoint, service_id);
      row.arrival_ns = setpoint->arrival_ns;
      setpoints->pop();
      end.see(row.setpoint);
      book.add(row);
      (void)writer->write(row);
    }
    if (!is_last) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  std::cout << book.to_text();
  if (setpoints->overrun() > 0) {
    std::cout << "  " << setpoints->overrun() << " setpoints came faster than they were written\n";
  }
  if (!writer->close()) {
    std::cerr << options.output << ": " << std::strerror(writer->error_number()) << "\n";
    return kInputRefused;
  }
  if (book.received() == 0) return kNoPeer;
  const bool is_bad =
      options.max_missing >= 0 && book.missing() > static_cast<std::uint64_t>(options.max_missing);
  return is_bad ? kVerdictNo : kFine;
}

int refuse(const record::RecordError& error) {
  std::cerr << error.text() << "\n";
  return kInputRefused;
}

int read(const Options& options) {
  const MachineModel model = load_machine(options.machine);
  auto recording = record::RecordingReader::open(options.flight, model);
  if (!recording) return refuse(recording.error());
  const auto report = record::read_flight(*recording, model);
  if (!report) return refuse(report.error());
  std::cout << record::to_text(*report, model);
  if (options.picture.empty()) return kFine;
  const auto error = record::draw_flight(*recording, *report, model, options.picture);
  return error ? refuse(*error) : kFine;
}

int convert(const Options& options) {
  const MachineModel model = load_machine(options.machine);
  const auto report = ros::convert(options.recording, options.mcap, model);
  if (!report) return refuse(report.error());
  std::cout << ros::to_text(*report, options.mcap);
  return kFine;
}

}  // namespace

void add_record_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "record",
      "Setpoints and feedback as they are seen on the wire, into a recording, with the gaps, the "
      "age of what arrives and the following error. Or, with --read, what such a recording or one "
      "of the flight recorder says of a fault. Or, with --convert, any recording as an MCAP file "
      "for Foxglove and PlotJuggler");
  command->add_option("output", options->output, "Recording to write (CSV)");
  CLI::Option* const read_option =
      command->add_option("--read", options->flight,
                          "Instead: tell alarm, stop, following errors and what drives reported, "
                          "out of this file of the flight recorder or of this command");
  CLI::Option* const convert_option =
      command
          ->add_option("--convert", options->recording,
                       "Instead: write this recording (CSV) of the service, the simulator, the "
                       "flight recorder or this command, with its events, to the file behind "
                       "--mcap")
          ->excludes(read_option);
  CLI::Option* const mcap =
      command->add_option("--mcap", options->mcap, "For --convert: MCAP file to write")
          ->needs(convert_option);
  convert_option->needs(mcap);
  CLI::Option* const machine = command->add_option("-m,--machine", options->machine.machine,
                                                   "For --read and --convert: machine file (TOML)");
  read_option->needs(machine);
  convert_option->needs(machine);
  add_workpiece_options(*command, options->machine);
  command->add_option("--picture", options->picture, "For --read: draw it to this .png or .svg")
      ->needs(read_option);
  command->add_option("--duration", options->duration_s, "End after so many seconds")
      ->check(finite_positive());
  command->add_flag("--until-end", options->until_end, "End when the program in the machine ends");
  command->add_option("--max-missing", options->max_missing,
                      "Exit code 1 where more cycles are missing");
  add_peer_options(*command, options->peer);
  command->callback([options, machine, &exit_code] {
    const bool is_listening = options->flight.empty() && options->recording.empty();
    if (is_listening && machine->count() > 0) {
      throw CLI::ValidationError("--machine", "belongs to --read or --convert");
    }
    if (is_listening == options->output.empty()) {
      throw CLI::ValidationError("record",
                                 "name the recording to write, or one behind --read or --convert");
    }
    exit_code = !options->recording.empty() ? convert(*options)
                : is_listening              ? run(*options)
                                            : read(*options);
  });
}

}  // namespace meridian::cli
