// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "meridian/units.hpp"
#include "service/analysis/simulate/simulate.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/recording/record/check/check.hpp"
#include "service/recording/record/file/recording_reader.hpp"
#include "service/recording/record/file/recording_writer.hpp"
#include "support/shared_folder.hpp"

/// Real CL files, in shared_folder(), simulated and checked.
namespace meridian::test {

inline constexpr double kTipTolerance_mm = 1e-3;  // what the rest-to-rest planner owes
inline constexpr double kAxisTolerance_deg = 1e-3;

/// The machine of deploy/machines/lai.toml with the workpiece at `frame` and its own cycle time, in
/// exact stop.
[[nodiscard]] inline MachineModel lai_at(const char* frame, std::int64_t cycle_ns) {
  MachineModel model =
      config::load_machine(std::string(MERIDIAN_SOURCE_DIR) + "/deploy/machines/lai.toml");
  config::place_workpiece(model, config::parse_frame(frame));
  model.cycle_ns = cycle_ns;
  model.transition = Transition::kExactStop;
  return model;
}

/// The tools that the corpus calls, all as long as the one in the spindle.
[[nodiscard]] inline ToolTable corpus_tools(const MachineModel& model) {
  return ToolTable({{1, model.tool_length_mm, 5}, {45, model.tool_length_mm, 5}});
}

[[nodiscard]] inline cl::ClReaderOptions corpus_reader() {
  cl::ClReaderOptions options;
  options.unit = cl::LengthUnit::kMillimetre;
  return options;
}

/// From rest to rest by what that planner owes, smooth by the tolerances of the machine.
[[nodiscard]] inline record::CheckOptions corpus_check(Transition transition) {
  record::CheckOptions options;
  if (transition == Transition::kSmooth) return options;
  options.tip_tolerance_mm = kTipTolerance_mm;
  options.axis_tolerance_rad = units::rad_from_deg(kAxisTolerance_deg);
  return options;
}

/// Writes the first lines of a CL file and the end of a program to `head`.
inline void write_head(const std::filesystem::path& file, int lines,
                       const std::filesystem::path& head) {
  std::ifstream in(file, std::ios::binary);
  std::ofstream out(head, std::ios::binary);
  std::string line;
  for (int n = 0; n < lines && std::getline(in, line); ++n) out << line << "\n";
  out << "FINI\n";
}

/// A CL file, its path, and the recording of its simulated run, which goes with this object.
class SimulatedFile {
 public:
  SimulatedFile(std::filesystem::path file, MachineModel machine)
      : model(std::move(machine)),
        path(model.tool_length_mm, model.max_feed_mm_per_s),
        file_(std::move(file)),
        recording_(std::filesystem::temp_directory_path() /
                   ("meridian-corpus-" + std::to_string(::getpid()) + ".csv")) {
    read_path();
    auto writer = record::RecordingWriter::create(recording_, model);
    std::ifstream in(file_, std::ios::binary);
    cl::ClReader reader(in, file_.filename(), corpus_reader());
    report =
        simulate::simulate(reader, file_.filename(), model, corpus_tools(model), {},
                           [&writer](const CycleRecord& row) { EXPECT_TRUE(writer->write(row)); });
    EXPECT_TRUE(writer->close());
  }
  ~SimulatedFile() {
    std::error_code ignored;
    std::filesystem::remove(recording_, ignored);
  }
  SimulatedFile(const SimulatedFile&) = delete;
  SimulatedFile& operator=(const SimulatedFile&) = delete;

  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  [[nodiscard]] const std::filesystem::path& recording() const noexcept { return recording_; }

  [[nodiscard]] record::CheckReport check() const {
    auto reader = record::RecordingReader::open(recording_, model);
    auto verdict = record::check(*reader, path, model, corpus_check(model.transition));
    EXPECT_TRUE(verdict.has_value()) << verdict.error().text();
    verdict->path_name = file_.filename();
    return *verdict;
  }

  MachineModel model;
  record::CheckedPath path;
  simulate::SimulateReport report;

 private:
  void read_path() {
    std::ifstream in(file_, std::ios::binary);
    cl::ClReader reader(in, file_.filename(), corpus_reader());
    while (true) {
      const auto block = reader.next();
      EXPECT_TRUE(block.has_value()) << block.error().text();
      if (!block || !*block) return;
      path.add(**block, model.tool_length_mm);
    }
  }

  std::filesystem::path file_, recording_;
};

}  // namespace meridian::test
