// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/stream_run.hpp"

#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>

#include "meridian/cycle/state_table.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/protocol/operator_link.hpp"
#include "service/protocol/source_pump.hpp"
#include "service/protocol/station.hpp"
#include "service/protocol/station_link.hpp"
#include "service/protocol/steady_ns.hpp"
#include "service/text/checksum.hpp"

namespace meridian::stream {

namespace {

std::string file_name(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

constexpr const char* kStandardInput = "standard input";

bool is_pipe(const StreamOptions& options) { return options.file == "-"; }

/// The checksum of all that is in `file`, which is at its begin again afterwards.
std::uint64_t checksum_of(std::ifstream& file) {
  text::Checksum sum;
  std::array<char, 65'536> bytes;
  while (file.read(bytes.data(), bytes.size()) || file.gcount() > 0) {
    sum.add({bytes.data(), static_cast<std::size_t>(file.gcount())});
  }
  file.clear();
  file.seekg(0);
  return sum.sum();
}

/// Whether it is a file that is there to be read twice.
bool is_regular(const StreamOptions& options) {
  std::error_code ignored;
  return !is_pipe(options) && std::filesystem::is_regular_file(options.file, ignored);
}

dds::SessionRequest request_of(const StreamOptions& options) {
  dds::SessionRequest request;
  request.session = draw_id();
  request.station = options.station;
  request.program = is_pipe(options) ? kStandardInput : file_name(options.file);
  request.tip_tolerance_mm = options.tip_tolerance_mm;
  request.axis_tolerance_rad = options.axis_tolerance_rad;
  request.policies = options.policies;
  request.options = options.options;
  request.from_line = options.reader.first_line;
  request.frame = options.frame;
  request.tools = options.tools;
  request.limits = options.limits;
  if (options.preflight) {
    request.block_count = options.preflight->blocks;
    if (options.preflight->contains_actions) request.policies |= dds::kPolicyContainsActions;
  }
  return request;
}

/// Says once what is new.
class Newsreader {
 public:
  explicit Newsreader(const StreamListener& listener) : listener_(listener) {}

  void station(const std::string& message) { report(message, station_); }
  void status(const dds::Status& status) {
    report(status.message, machine_);
    if (has_state_ && status.state == state_) return;
    has_state_ = true;
    state_ = status.state;
    const bool is_known = static_cast<int>(state_) < kStateCount;
    listener_.say(std::string("machine is ") + (is_known ? name_of(state_) : "unknown"));
  }

 private:
  void report(const std::string& message, std::string& last) {
    if (message.empty() || message == station_ || message == machine_) return;
    last = message;
    listener_.say(message);
  }

  const StreamListener& listener_;
  std::string station_, machine_;
  State state_ = State::kOff;
  bool has_state_ = false;
};

/// The first status without the session says how its program went; the credit comes before it.
void hear_end(StationLink& link, std::uint64_t session, Newsreader& news) {
  constexpr std::chrono::milliseconds kLook{50};
  constexpr std::int64_t kPatience_ns = 1'000'000'000;
  const std::int64_t begin_ns = steady_ns();
  while (steady_ns() - begin_ns < kPatience_ns) {
    link.work(kLook);
    const auto status = link.take_status();
    if (!status) continue;
    news.status(*status);
    if (status->session != session) return;
  }
}

}  // namespace

StreamEnd run_stream(dds::Participant& participant, const StreamOptions& options,
                     const std::atomic<bool>& is_stopping, const StreamListener& listener) {
  std::ifstream file;
  if (!is_pipe(options)) {
    file.open(options.file, std::ios::binary);
    if (!file) {
      listener.say(options.file + ": cannot be opened; check the path and the right to read it");
      return StreamEnd::kInputRefused;
    }
  }
  dds::SessionRequest request = request_of(options);
  if (is_regular(options)) request.file_checksum = checksum_of(file);
  cl::ClReader reader(file, options.file, options.reader);
  Source source = [&reader] { return supply_of(reader); };
  Station station(request, [&source] { return source(); });
  StationLink link(participant, station);
  std::optional<SourcePump> pump;
  if (is_pipe(options)) {
    pump.emplace(STDIN_FILENO, kStandardInput, options.reader, [&link] { link.wake(); });
    source = [&pump] { return pump->take(); };
  }
  auto say_warnings = [&, reported = std::size_t{0}]() mutable {
    if (options.preflight) return;
    const auto say = [&](const cl::ClWarning& warning) {
      listener.say(request.program + ":" + std::to_string(warning.line) +
                   ": warning: " + warning.message);
    };
    if (pump) {
      for (const cl::ClWarning& warning : pump->take_warnings()) say(warning);
    }
    for (; reported < reader.warnings().size(); ++reported) say(reader.warnings()[reported]);
  };
  ProgressMeter meter(options.preflight ? options.preflight->times : TimeTable{});
  Newsreader news(listener);

  constexpr std::chrono::milliseconds kIdle{50};
  constexpr std::int64_t kPatience_ns = 5'000'000'000;
  std::int64_t heard_ns = steady_ns();
  while (!station.is_over()) {
    if (station.state() == StationState::kComplete && !options.is_waiting_for_end) break;
    if (is_stopping.load()) {
      link.close();
      listener.say("interrupted: the machine runs the blocks that it has and stops");
      return StreamEnd::kInterrupted;
    }
    const bool has_credit = link.work(kIdle);
    say_warnings();
    news.station(station.message());
    const std::int64_t now_ns = steady_ns();
    if (has_credit) heard_ns = now_ns;
    if (const auto status = link.take_status()) {
      heard_ns = now_ns;
      const bool is_ours = status->session == request.session;
      if (is_ours) {
        const ProgressView view = meter.look(*status, now_ns);
        if (view.is_under_way) listener.show(view);
      }
      if (is_ours || station.state() != StationState::kOpening) news.status(*status);
    } else if (now_ns - heard_ns > kPatience_ns) {
      listener.say("no word from the service for 5 s: is meridiand still running?");
      return StreamEnd::kNoPeer;
    }
  }
  const dds::Verdict verdict = station.credit().verdict;
  const bool has_ended = verdict == dds::Verdict::kRan || verdict == dds::Verdict::kAborted;
  if (has_ended) hear_end(link, request.session, news);
  switch (station.state()) {
    case StationState::kComplete:
    case StationState::kRan:
      return StreamEnd::kFine;
    case StationState::kBadSource:
      link.close();
      listener.say(station.message());
      return StreamEnd::kInputRefused;
    case StationState::kNoAnswer:
      listener.say(station.message());
      return StreamEnd::kNoPeer;
    default:
      return StreamEnd::kMachineRefused;
  }
}

}  // namespace meridian::stream
