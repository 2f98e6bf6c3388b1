// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "service/programs/cl/cl_options.hpp"
#include "service/protocol/station/preflight.hpp"
#include "service/protocol/station/progress.hpp"
#include "service/transport/participant.hpp"

namespace meridian::stream {

struct StreamOptions {
  std::string file;     ///< "-": standard input
  std::string station;  ///< name of this station, for messages
  cl::ClReaderOptions reader;
  std::optional<PreflightReport> preflight;  ///< nothing: not done
  bool is_waiting_for_end = false;           ///< until the machine ran the program
  double tip_tolerance_mm = 0;               ///< 0: the machine's
  double axis_tolerance_rad = 0;             ///< 0: the machine's
  std::uint32_t policies = 0;                ///< dds::SessionPolicy, beside what the file says
  std::uint64_t frame = 0;                   ///< frame_sum() that it was checked under; 0: none
  std::uint64_t tools = 0;                   ///< tools_sum() that it was checked with; 0: none
  std::uint64_t limits = 0;                  ///< limits_sum() that it was checked under; 0: none
  std::string options;                       ///< what asked for this, for who goes on with it
};

enum class StreamEnd : std::uint8_t {
  kFine,
  kInterrupted,
  kInputRefused,
  kMachineRefused,
  kNoPeer
};

/// Who hears what happens.
struct StreamListener {
  std::function<void(const std::string&)> say;  ///< what station and machine say, once each
  std::function<void(const ProgressView&)> show;
};

/// Streams a CL file into the machine of `participant`, until everything is in (or ran, see
/// options), somebody refuses, or `is_stopping`. Throws DdsError at start.
[[nodiscard]] StreamEnd run_stream(dds::Participant& participant, const StreamOptions& options,
                                   const std::atomic<bool>& is_stopping,
                                   const StreamListener& listener);

}  // namespace meridian::stream
