// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "service/recording/record/file/recording_reader.hpp"
#include "service/recording/record/file/recording_writer.hpp"
#include "support/scratch.hpp"
#include "support/text_file.hpp"

namespace meridian::test {

inline void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// Writes the records as a recording and opens it.
[[nodiscard]] inline record::RecordingReader write_and_open(
    const std::string& path, const MachineModel& model, const std::vector<CycleRecord>& records) {
  auto writer = record::RecordingWriter::create(path, model);
  EXPECT_TRUE(writer.has_value());
  for (const CycleRecord& record : records) EXPECT_TRUE(writer->write(record));
  EXPECT_TRUE(writer->close());
  auto reader = record::RecordingReader::open(path, model);
  EXPECT_TRUE(reader.has_value()) << reader.error().text();
  return std::move(*reader);
}

}  // namespace meridian::test
