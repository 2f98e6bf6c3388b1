// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "service/analysis/simulate/simulate.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/recording/record/check/check.hpp"
#include "service/recording/record/file/recording_reader.hpp"
#include "service/recording/record/file/recording_writer.hpp"

/// A CL text simulated, and its recording checked.
namespace meridian::test {

struct SimulatedRun {
  simulate::SimulateReport report;
  std::vector<CycleRecord> records;
};

[[nodiscard]] inline SimulatedRun run_simulation(std::string_view text, const MachineModel& model,
                                                 const simulate::SimulateOptions& options = {},
                                                 const ToolTable& tools = {}) {
  SimulatedRun run;
  cl::ClReader reader(text, "part.apt");
  run.report =
      simulate::simulate(reader, "part.apt", model, tools, options,
                         [&run](const CycleRecord& record) { run.records.push_back(record); });
  return run;
}

[[nodiscard]] inline record::CheckedPath path_of(std::string_view text, const MachineModel& model,
                                                 const ToolTable& tools = {}) {
  record::CheckedPath path(model.tool_length_mm, model.max_feed_mm_per_s);
  cl::ClReader reader(text, "part.apt");
  while (true) {
    const auto block = reader.next();
    EXPECT_TRUE(block.has_value()) << block.error().text();
    if (!block || !*block) return path;
    const Tool* tool = (*block)->kind == BlockKind::kTool
                           ? tools.find(static_cast<int>((*block)->value))
                           : nullptr;
    path.add(**block, tool != nullptr ? tool->length_mm : 0);
  }
}

/// Checks `records` by way of the file `recording`.
[[nodiscard]] inline record::CheckReport check_records(const std::vector<CycleRecord>& records,
                                                       const record::CheckedPath& path,
                                                       const MachineModel& model,
                                                       const record::CheckOptions& options,
                                                       const std::string& recording) {
  auto writer = record::RecordingWriter::create(recording, model);
  EXPECT_TRUE(writer.has_value());
  for (const CycleRecord& record : records) EXPECT_TRUE(writer->write(record));
  EXPECT_TRUE(writer->close());
  auto reader = record::RecordingReader::open(recording, model);
  EXPECT_TRUE(reader.has_value());
  auto report = record::check(*reader, path, model, options);
  EXPECT_TRUE(report.has_value());
  return *report;
}

}  // namespace meridian::test
