// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "service/panel/desks/outcome.hpp"
#include "service/panel/desks/program_folder.hpp"
#include "service/panel/program/program_preview.hpp"
#include "service/panel/serve/hub.hpp"
#include "service/protocol/station/stream_run.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/participant.hpp"

namespace meridian::panel {

/// The panel as a station: gets a program from a page, checks it as a whole, simulates it, and
/// streams it. What stands with it is published to the hub as text (program_text.hpp). Checks and
/// simulation run on a thread of the lowest priority, the stream on another one; a program is
/// streamed only where the check of it, from that line on and in this work frame, found nothing
/// that is in the way. Blocks alone move nothing. Any thread may ask.
/// Proof: tests/panel/browser_test.mjs.
class ProgramDesk {
 public:
  /// What the machine is, as its service reported last; nothing: it is silent.
  using Machine = std::function<std::optional<dds::MachineInfo>()>;

  /// `participant` and `hub` must live on. Throws std::filesystem::filesystem_error.
  ProgramDesk(dds::Participant& participant, Hub& hub, Machine machine, std::string station);
  /// Ends the check; closes the session of a stream: the machine runs what it has and stops.
  ~ProgramDesk();
  ProgramDesk(const ProgramDesk&) = delete;
  ProgramDesk& operator=(const ProgramDesk&) = delete;

  /// Gets a program of `bytes` bytes and begins its check.
  [[nodiscard]] Outcome receive(std::string_view name, std::uint64_t bytes,
                                const ProgramFolder::ReadBytes& read);
  /// Checks the program that is there again, from `first_line` on; 0: all of it.
  [[nodiscard]] Outcome check(std::uint32_t first_line);
  /// Begins to stream what was checked.
  [[nodiscard]] Outcome load();
  /// Ends the stream: the machine runs the blocks that it has and stops.
  [[nodiscard]] Outcome unload();

  /// Lines of the program for a page to show.
  [[nodiscard]] std::string read_lines(std::uint64_t first, std::uint64_t count) const;
  /// ProgramPath::bytes() of the program; nullptr: none is there yet.
  [[nodiscard]] Hub::Text path() const;

  /// How far it has come with a program.
  enum class Phase : std::uint8_t { kNone, kChecking, kRefused, kReady, kStreaming };
  /// All that pages are told of the program.
  struct View {
    Phase phase = Phase::kNone;
    ProgramFolder::Program program;
    std::uint32_t first_line = 0;
    stream::PreflightReport preflight;
    std::string placing;  ///< where it would fit
    bool is_simulating = false;
    SimulatedProgram simulated;     ///< its path is beside it, path()
    std::uint64_t path_number = 0;  ///< 0: no path yet
    std::string station, message;
  };

 private:
  struct Job {
    std::uint64_t number = 0;
    std::string file;
    std::uint32_t first_line = 0;
  };
  void run_checks();
  void run_check(const Job& job);
  void run_stream(stream::StreamOptions options);
  void begin_check(std::uint32_t first_line);
  [[nodiscard]] bool is_overtaken(const Job& job) const;
  /// Changes the view and publishes it, unless another job has taken over.
  void change(const Job& job, const std::function<void(View&)>& how);
  void say(const std::string& message);
  void publish() const;

  dds::Participant& participant_;
  Hub& hub_;
  Machine machine_;
  ProgramFolder folder_;
  std::mutex receiving_;      ///< one program at a time comes in
  mutable std::mutex mutex_;  ///< of all below
  std::condition_variable changed_;
  View view_;
  Hub::Text path_;
  cl::ClReaderOptions reader_;  ///< of the program that was checked, and the frame of that check
  std::uint64_t frame_ = 0, limits_ = 0, tools_ = 0, path_count_ = 0;
  std::optional<Job> job_;  ///< that waits
  std::atomic<std::uint64_t> newest_job_{0};
  std::atomic<bool> is_ending_{false}, is_unloading_{false};
  std::thread checks_, stream_;
};

}  // namespace meridian::panel
