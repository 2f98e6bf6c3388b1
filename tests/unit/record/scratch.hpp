// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "service/recording/record/file/recording_reader.hpp"
#include "service/recording/record/file/recording_writer.hpp"

namespace meridian::test {

/// A file name of this process that is removed at the end.
class Scratch {
 public:
  explicit Scratch(const std::string& ending)
      : path_(::testing::TempDir() + "meridian_" + std::to_string(::getpid()) + "_" +
              std::to_string(count_++) + ending) {}
  ~Scratch() { std::remove(path_.c_str()); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  static inline int count_ = 0;
  std::string path_;
};

inline void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

[[nodiscard]] inline std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
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
