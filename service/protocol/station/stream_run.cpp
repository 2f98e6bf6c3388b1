// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/station/stream_run.hpp"

#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>

#include "meridian/cycle/state_table.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/protocol/operator/operator_link.hpp"
#include "service/protocol/station/source_pump.hpp"
#include "service/protocol/station/station.hpp"
#include "service/protocol/station/station_link.hpp"
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

dds::SessionRequest request_of(const StreamOptions& options, std::ifstream& file) {
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
  if (is_regular(options)) request.file_checksum = checksum_of(file);
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

constexpr std::int64_t kPatience_ns = 5'000'000'000;

/// One program on its path into the machine.
class StreamRun {
 public:
  /// `file` is open, or the source is a pipe.
  StreamRun(dds::Participant& participant, const StreamOptions& options, std::ifstream& file,
            const StreamListener& listener)
      : options_(options),
        listener_(listener),
        request_(request_of(options, file)),
        reader_(file, options.file, options.reader),
        station_(request_, [this] { return pump_ ? pump_->take() : supply_of(reader_); }),
        link_(participant, station_),
        meter_(options.preflight ? options.preflight->times : TimeTable{}),
        news_(listener) {
    if (!is_pipe(options)) return;
    pump_.emplace(STDIN_FILENO, kStandardInput, options.reader, [this] { link_.wake(); });
  }
  StreamRun(const StreamRun&) = delete;
  StreamRun& operator=(const StreamRun&) = delete;

  [[nodiscard]] StreamEnd run(const std::atomic<bool>& is_stopping) {
    heard_ns_ = steady_ns();
    while (!station_.is_over()) {
      if (station_.state() == StationState::kComplete && !options_.is_waiting_for_end) break;
      if (is_stopping.load()) {
        link_.close();
        listener_.say("interrupted: the machine runs the blocks that it has and stops");
        return StreamEnd::kInterrupted;
      }
      if (!follow()) {
        listener_.say("no word from the service for 5 s: is meridiand still running?");
        return StreamEnd::kNoPeer;
      }
    }
    const dds::Verdict verdict = station_.credit().verdict;
    const bool has_ended = verdict == dds::Verdict::kRan || verdict == dds::Verdict::kAborted;
    if (has_ended) hear_end(link_, request_.session, news_);
    return end();
  }

 private:
  /// One turn of the link, and what came with it. False where the service is silent for too long.
  [[nodiscard]] bool follow() {
    constexpr std::chrono::milliseconds kIdle{50};
    const bool has_credit = link_.work(kIdle);
    say_warnings();
    news_.station(station_.message());
    const std::int64_t now_ns = steady_ns();
    if (has_credit) heard_ns_ = now_ns;
    const auto status = link_.take_status();
    if (!status) return now_ns - heard_ns_ <= kPatience_ns;
    heard_ns_ = now_ns;
    const bool is_ours = status->session == request_.session;
    if (is_ours) {
      const ProgressView view = meter_.look(*status, now_ns);
      if (view.is_active) listener_.show(view);
    }
    if (is_ours || station_.state() != StationState::kOpening) news_.status(*status);
    return true;
  }

  /// Says what the reader found odd, where no check before has said it.
  void say_warnings() {
    if (options_.preflight) return;
    const auto say = [this](const cl::ClWarning& warning) {
      listener_.say(request_.program + ":" + std::to_string(warning.line) +
                    ": warning: " + warning.message);
    };
    if (pump_) {
      for (const cl::ClWarning& warning : pump_->take_warnings()) say(warning);
    }
    for (; warnings_said_ < reader_.warnings().size(); ++warnings_said_) {
      say(reader_.warnings()[warnings_said_]);
    }
  }

  /// What became of it, as the station saw it.
  [[nodiscard]] StreamEnd end() {
    switch (station_.state()) {
      case StationState::kComplete:
      case StationState::kRan:
        return StreamEnd::kFine;
      case StationState::kBadSource:
        link_.close();
        listener_.say(station_.message());
        return StreamEnd::kInputRefused;
      case StationState::kNoAnswer:
        listener_.say(station_.message());
        return StreamEnd::kNoPeer;
      default:
        return StreamEnd::kMachineRefused;
    }
  }

  const StreamOptions& options_;
  const StreamListener& listener_;
  dds::SessionRequest request_;
  cl::ClReader reader_;
  Station station_;
  StationLink link_;
  std::optional<SourcePump> pump_;  ///< of standard input
  ProgressMeter meter_;
  Newsreader news_;
  std::size_t warnings_said_ = 0;
  std::int64_t heard_ns_ = 0;  ///< when the service said anything last
};

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
  return StreamRun(participant, options, file, listener).run(is_stopping);
}

}  // namespace meridian::stream
