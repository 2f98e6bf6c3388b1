// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/bench/bench_run.hpp"

#include <cstring>
#include <string_view>
#include <utility>

#include "service/analysis/bench/bench_paths.hpp"
#include "service/analysis/certify/certifier.hpp"
#include "service/analysis/simulate/simulate.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/recording/record/check/check.hpp"
#include "service/recording/record/file/recording_reader.hpp"
#include "service/recording/record/file/recording_writer.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::bench {
namespace {

using Failure = tl::unexpected<std::string>;

/// The path as the checker wants it; the file is our own and has no errors.
record::CheckedPath checked_path(const std::string& text, const std::string& name,
                                 const MachineModel& model) {
  record::CheckedPath path(model.tool_length_mm, model.max_feed_mm_per_s);
  cl::ClReader reader(std::string_view(text), name);
  for (auto block = reader.next(); block && *block; block = reader.next()) path.add(**block, 0);
  return path;
}

}  // namespace

bool BenchResult::is_in_order() const noexcept {
  return plan.outcome == simulate::Outcome::kDone && verdict.passed() &&
         (!certificate || certificate->is_given());
}

Expected<BenchResult, std::string> run_path(const std::string& name, const MachineModel& model,
                                            const BenchOptions& options) {
  const bool is_exact = model.pole_policy == PolePolicy::kExact;
  const std::string file = options.folder + "/" + name + ".apt";
  const std::string recording = options.folder + "/" + name + (is_exact ? ".exact.csv" : ".csv");
  const std::string text = path_file(name, options.feed_mm_per_s);
  if (!text::write_whole(file, text)) return Failure(file + " cannot be written");
  auto writer = record::RecordingWriter::create(recording, model);
  if (!writer) return Failure(writer.error().text());

  BenchResult result{name, model.pole_policy, {}, {}, {}};
  certify::Certifier certifier(model);
  simulate::SimulateOptions simulation;
  simulation.settings.transition = Transition::kSmooth;
  if (options.is_certified) simulation.certifier = &certifier;
  cl::ClReader reader(std::string_view(text), file);
  result.plan = simulate::simulate(reader, file, model, {}, simulation,
                                   [&](const CycleRecord& row) { (void)writer->write(row); });
  if (!writer->close()) return Failure(recording + ": " + std::strerror(writer->error_number()));
  if (result.plan.outcome != simulate::Outcome::kDone)
    return Failure(name + ": " + result.plan.reason);
  if (options.is_certified) result.certificate = certifier.certificate();

  auto rows = record::RecordingReader::open(recording, model);
  if (!rows) return Failure(rows.error().text());
  auto verdict = record::check(*rows, checked_path(text, file, model), model, {});
  if (!verdict) return Failure(verdict.error().text());
  result.verdict = std::move(*verdict);
  return result;
}

}  // namespace meridian::bench
