// SPDX-License-Identifier: Apache-2.0
#include "service/panel/desks/program_desk.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <utility>

#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/panel/program/program_text.hpp"
#include "service/protocol/frame_sum.hpp"
#include "service/protocol/limits_sum.hpp"
#include "service/protocol/tools_sum.hpp"

namespace meridian::panel {
namespace {

/// Motion, drives and pages come first.
void run_at_lowest_priority() {
  constexpr int kLowest = 19;
  static_cast<void>(::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kLowest));
}

[[nodiscard]] std::uint64_t frame_of(const dds::MachineInfo& info) {
  return stream::frame_sum(info.frame_rotation, info.frame_origin_mm, info.work_frames);
}

/// Of the tool table that the machine has; 0: of none.
[[nodiscard]] std::uint64_t tools_of(const dds::MachineInfo& info) {
  if (info.tool_file.empty()) return 0;
  return stream::tools_sum(config::parse_tools(info.tool_file, "tool table of the service"));
}

constexpr const char* kStreams = "a program is streamed: abort it, or end the stream, first";
constexpr const char* kMachineIsSilent = "the machine is silent";

}  // namespace

ProgramDesk::ProgramDesk(dds::Participant& participant, Hub& hub, Machine machine,
                         std::string station)
    : participant_(participant), hub_(hub), machine_(std::move(machine)) {
  view_.station = std::move(station);
  publish();
  checks_ = std::thread([this] { run_checks(); });
}

ProgramDesk::~ProgramDesk() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
    is_unloading_ = true;
    ++newest_job_;
  }
  changed_.notify_all();
  checks_.join();
  if (stream_.joinable()) stream_.join();
}

// ---- what is asked for

Outcome ProgramDesk::receive(std::string_view name, std::uint64_t bytes,
                             const ProgramFolder::ReadBytes& read) {
  const std::unique_lock receiving(receiving_, std::try_to_lock);
  if (!receiving) return {false, "another program is on its way to the panel"};
  {
    const std::lock_guard lock(mutex_);
    if (view_.phase == Phase::kStreaming) return {false, kStreams};
  }
  auto program = folder_.receive(name, bytes, read);
  if (!program) return {false, program.error()};
  const std::lock_guard lock(mutex_);
  if (view_.phase == Phase::kStreaming) return {false, kStreams};
  folder_.adopt(*program);
  view_.program = std::move(*program);
  begin_check(0);
  return {true, view_.program.name + " is checked"};
}

Outcome ProgramDesk::check(std::uint32_t first_line) {
  const std::lock_guard lock(mutex_);
  if (view_.phase == Phase::kNone) return {false, "no program: drop a file on the page"};
  if (view_.phase == Phase::kStreaming) return {false, kStreams};
  begin_check(first_line);
  return {true, view_.program.name + " is checked"};
}

/// With the lock.
void ProgramDesk::begin_check(std::uint32_t first_line) {
  View next;
  next.phase = Phase::kChecking;
  next.program = std::move(view_.program);
  next.station = std::move(view_.station);
  next.first_line = first_line;
  view_ = std::move(next);
  path_ = nullptr;
  job_ = Job{++newest_job_, folder_.file(), first_line};
  publish();
  changed_.notify_all();
}

Outcome ProgramDesk::load() {
  const auto machine = machine_();
  if (!machine) return {false, kMachineIsSilent};
  const std::lock_guard lock(mutex_);
  if (view_.phase == Phase::kStreaming) return {false, kStreams};
  if (view_.phase != Phase::kReady)
    return {false, "the check of the program is not done, or found what is in the way"};
  if (frame_of(*machine) != frame_) {
    return {false, "the work frame is another one than at the check: check the program again"};
  }
  if (stream::limits_sum(machine->soft_limits) != limits_) {
    return {false, "the soft limits are others than at the check: check the program again"};
  }
  if (tools_of(*machine) != tools_) {
    return {false, "the tool table is another one than at the check: check the program again"};
  }
  stream::StreamOptions options;
  options.file = folder_.file();
  options.station = view_.station;
  options.reader = reader_;
  options.preflight = view_.preflight;
  options.is_waiting_for_end = true;
  options.frame = frame_;
  options.limits = limits_;
  options.tools = tools_;
  if (view_.first_line > 0) options.policies |= dds::kPolicyRetractFirst;
  if (stream_.joinable()) stream_.join();
  is_unloading_ = false;
  view_.phase = Phase::kStreaming;
  view_.message.clear();
  publish();
  stream_ = std::thread([this, options = std::move(options)] { run_stream(options); });
  return {true, view_.program.name + " is streamed"};
}

Outcome ProgramDesk::unload() {
  const std::lock_guard lock(mutex_);
  if (view_.phase != Phase::kStreaming) return {false, "nothing is streamed"};
  is_unloading_ = true;
  return {true, "the machine runs the blocks that it has and stops"};
}

std::string ProgramDesk::read_lines(std::uint64_t first, std::uint64_t count) const {
  const std::lock_guard lock(mutex_);
  if (view_.phase == Phase::kNone) return "";
  return folder_.read_lines(view_.program, first, count);
}

Hub::Text ProgramDesk::path() const {
  const std::lock_guard lock(mutex_);
  return path_;
}

// ---- the thread of the checks

void ProgramDesk::run_checks() {
  run_at_lowest_priority();
  for (;;) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return is_ending_ || job_; });
      if (is_ending_) return;
      job = std::move(*job_);
      job_.reset();
    }
    run_check(job);
  }
}

bool ProgramDesk::is_overtaken(const Job& job) const { return job.number != newest_job_; }

void ProgramDesk::change(const Job& job, const std::function<void(View&)>& how) {
  const std::lock_guard lock(mutex_);
  if (is_overtaken(job)) return;
  how(view_);
  publish();
}

void ProgramDesk::run_check(const Job& job) {
  const auto refuse = [this, &job](const std::string& why) {
    change(job, [&why](View& view) {
      view.phase = Phase::kRefused;
      view.message = why;
    });
  };
  const auto info = machine_();
  if (!info) return refuse(kMachineIsSilent);
  stream::PreflightMachine machine;
  try {
    machine = reported_machine(*info);
  } catch (const config::ConfigError&) {
    return refuse("the machine's file is longer than its topic carries: use `meridian stream`");
  }
  const cl::ClReaderOptions reader = reader_for(machine, job.first_line);
  const stream::PreflightReport preflight = stream::preflight(job.file, reader, machine);
  const bool is_refused = preflight.is_refused;
  change(job, [&](View& view) {
    view.preflight = preflight;
    view.phase = is_refused ? Phase::kRefused : Phase::kReady;
    view.is_simulating = !is_refused;
    reader_ = reader;
    frame_ = frame_of(*info);
    limits_ = stream::limits_sum(info->soft_limits);
    tools_ = machine.tools ? stream::tools_sum(*machine.tools) : 0;
  });
  if (is_overtaken(job)) return;
  if (is_refused) {
    if (preflight.blocks > kMaxPlacedBlocks) return;
    const std::string placing = find_where_it_fits(job.file, reader, machine);
    return change(job, [&placing](View& view) { view.placing = placing; });
  }
  auto simulated =
      simulate_program(job.file, reader, machine, [this, &job] { return is_overtaken(job); });
  if (!simulated) return;
  auto path = std::make_shared<const std::string>(std::move(simulated->path));
  simulated->path.clear();
  change(job, [&](View& view) {
    view.is_simulating = false;
    view.simulated = std::move(*simulated);
    view.path_number = ++path_count_;
    path_ = std::move(path);
  });
}

// ---- the thread of the stream

void ProgramDesk::run_stream(stream::StreamOptions options) {
  std::string failure;
  try {
    static_cast<void>(stream::run_stream(participant_, options, is_unloading_,
                                         {.say = [this](const std::string& text) { say(text); },
                                          .show = [](const stream::ProgressView&) {}}));
  } catch (const dds::DdsError& error) {
    failure = error.what();
  }
  const std::lock_guard lock(mutex_);
  view_.phase = Phase::kReady;
  if (!failure.empty()) view_.message = failure;
  publish();
}

void ProgramDesk::say(const std::string& message) {
  const std::lock_guard lock(mutex_);
  if (message.starts_with("machine is ")) return;  // the page shows the state beside it
  view_.message = message;
  publish();
}

/// With the lock, or before the threads are there.
void ProgramDesk::publish() const { hub_.publish(Hub::kProgram, program_text(view_)); }

}  // namespace meridian::panel
