// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <istream>
#include <mutex>
#include <thread>
#include <vector>

#include "service/programs/cl/cl_reader.hpp"
#include "service/protocol/station/pipe_buffer.hpp"
#include "service/protocol/station/station.hpp"

namespace meridian::stream {

/// The next block of a CL file as a source hands it out; waits for the file.
[[nodiscard]] Supply supply_of(cl::ClReader& reader);

/// Reads a CL text from a pipe on a thread of its own, so that whoever sends the blocks never waits
/// for the writer of the text: take() gives the next block where one is there, else kWait.
///
/// It reads at most kBlocksAhead blocks ahead; then the pipe fills and its writer waits.
/// Proof: tests/unit/protocol/source_pump_test.cpp.
class SourcePump {
 public:
  static constexpr std::size_t kMaxSupplies = 4096;

  /// `wake` is called on the reading thread whenever there is something to take and the one who
  /// takes may be asleep. The descriptor must stay open as long as the pump lives. Throws
  /// std::system_error.
  SourcePump(int descriptor, const std::string& name, const cl::ClReaderOptions& options,
             std::function<void()> wake);
  /// Cuts the wait for the writer short.
  ~SourcePump();
  SourcePump(const SourcePump&) = delete;
  SourcePump& operator=(const SourcePump&) = delete;

  /// The next supply, never waiting; behind kEnd and kBad there is nothing.
  [[nodiscard]] Supply take();
  /// Oddities of the text that were not taken yet.
  [[nodiscard]] std::vector<cl::ClWarning> take_warnings();

 private:
  void run(const std::string& name, const cl::ClReaderOptions& options);
  /// False once the pump is to end.
  [[nodiscard]] bool put(Supply supply);

  PipeBuffer buffer_;
  std::istream stream_;
  std::function<void()> wake_;
  std::mutex mutex_;
  std::condition_variable has_room_;
  std::deque<Supply> supplies_;
  std::vector<cl::ClWarning> warnings_;
  bool is_stopping_ = false;
  std::thread thread_;
};

}  // namespace meridian::stream
