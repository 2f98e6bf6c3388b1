// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/analysis/certify/certificate.hpp"
#include "service/analysis/simulate/simulate_report.hpp"
#include "service/recording/record/check/check_report.hpp"

namespace meridian::bench {

struct BenchOptions {
  double feed_mm_per_s = 0;
  std::string folder;  ///< CL file and recording are written there
  bool is_certified = false;
};

/// What became of one path: what the planner says of it, what the recording shows, and what is
/// proved between its setpoints.
struct BenchResult {
  std::string path;
  PolePolicy policy = PolePolicy::kRelax;
  simulate::SimulateReport plan;
  record::CheckReport verdict;
  std::optional<certify::Certificate> certificate;

  [[nodiscard]] bool is_in_order() const noexcept;
};

/// Runs path `name` on `model` as `meridian simulate` does, checks the recording as
/// `meridian check` does, and certifies the plan where asked. The error is a message: no file can
/// be written, or the machine refuses the path.
[[nodiscard]] Expected<BenchResult, std::string> run_path(const std::string& name,
                                                          const MachineModel& model,
                                                          const BenchOptions& options);

/// The results as a table with a line each.
[[nodiscard]] std::string table_header();
[[nodiscard]] std::string table_row(const BenchResult& result);

}  // namespace meridian::bench
