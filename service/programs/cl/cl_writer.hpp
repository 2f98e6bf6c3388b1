// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <string>
#include <string_view>

#include "meridian/path/cl_block.hpp"

namespace meridian::cl {

/// Writes CL blocks as an APT file that ClReader, and CAM systems and post-processors, read back.
///
/// Metric, six decimals of a millimetre, nine of a tool axis; feed is written where it changes, the
/// axis with every point where it is tilted; the
/// same calls give the same bytes. Proof: tests/unit/cl/writer_test.cpp.
class ClWriter {
 public:
  /// Begins the file: name of the part, unit. The stream must live as long as the writer.
  ClWriter(std::ostream& out, std::string_view part);

  /// A comment line.
  void note(std::string_view text);
  /// One block; kEnd writes FINI. Arcs must begin where the block before them ended.
  void write(const ClBlock& block);

 private:
  void statement(std::string_view word, const std::string& arguments);
  void write_motion(const ClBlock& block);
  void write_auxiliary(const ClBlock& block);

  std::ostream& out_;
  FeedMeaning feed_meaning_ = FeedMeaning::kNone;
  double feed_ = 0;
  bool has_axis_ = false;
  Array3 axis_{};
};

}  // namespace meridian::cl
