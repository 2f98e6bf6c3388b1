// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

namespace meridian::soak {

/// A piece of a recording: from where the machine came to rest to where it rests again.
struct Segment {
  std::filesystem::path file;  ///< a new one each time; who gets the report removes it
  std::int64_t begin_ns = 0;   ///< when the program was under way first, machine's clock
  bool has_run = false;        ///< a program was on its way
  bool is_aborted = false;     ///< it was not brought to its end: abort, fault, death. An abort at
                               ///< rest shows by the next epoch alone
  std::uint64_t rows = 0;
};

/// Cuts the text of a recording, as the service writes it, into segments, one for each program, and
/// writes each to a file. Takes what comes in any portions; a new header begins a new recording.
/// Proof: tests/unit/soak/soak_test.cpp.
class Segments {
 public:
  using Report = std::function<void(const Segment&)>;
  Segments(std::filesystem::path folder, Report report);

  void add(std::string_view text);
  /// The service is gone: what there is, is the last of it.
  void cut_off();

 private:
  void add_line(std::string_view line);
  void end_segment(bool is_cut_off);

  std::filesystem::path folder_;
  Report report_;
  std::string header_, rest_;
  std::size_t state_column_ = 0, due_column_ = 0, epoch_column_ = 0;
  std::string epoch_;  ///< of the program that is under way
  Segment segment_;
  std::ofstream file_;
  int rest_rows_ = 0, count_ = 0;
};

}  // namespace meridian::soak
