// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>

#include "service/analysis/certify/certifier.hpp"
#include "service/analysis/simulate/feed_picture.hpp"
#include "service/analysis/simulate/simulate.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/machine_options.hpp"
#include "service/cli/options/view_option.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/protocol/frame_sum.hpp"
#include "service/protocol/station/smooth_tolerances.hpp"
#include "service/recording/record/file/recording_reader.hpp"
#include "service/recording/record/file/recording_writer.hpp"
#include "service/text/printed.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::cli::simulate_command {
namespace {

struct Options {
  std::string file, record, events, start_from, auxiliary = "ignore", pole_policy;
  std::string explain_table, picture, html;
  double override_ramp_s = 0;
  bool stops_at_optional = false, is_explained = false, is_certified = false;
  bool gives_findings = false;
  MachineOptions machine;
  JoinOptions join;
  ClFileOptions cl;
};

int refuse(const std::string& message) {
  std::cerr << message << "\n";
  return kInputRefused;
}

/// Where the drives are in the first enabled row.
[[nodiscard]] Expected<JointVector, record::RecordError> first_drives(const std::string& file,
                                                                      const MachineModel& model) {
  auto reader = record::RecordingReader::open(file, model);
  if (!reader) return tl::make_unexpected(reader.error());
  record::RecordingRow row;
  for (;;) {
    const auto read = reader->next(row);
    if (!read) return tl::make_unexpected(read.error());
    if (!*read) {
      return tl::make_unexpected(
          record::RecordError{file, 0, "the drives are never enabled in it", "name another"});
    }
    if (is_leading(row.flags)) return drives_at(model, row.positions);
  }
}

/// Where the time went, as the options ask for it: as text, as a table, as a picture, as a page.
class Explaining {
 public:
  Explaining(const Options& options, const MachineModel& model)
      : options_(options), model_(model), picture_(model), view_(model, options.html) {
    cause_.tool_length_mm = model.tool_length_mm;
    cause_.cause =
        static_cast<std::uint8_t>(simulate::Cause::kWaiting);  // nothing is explained yet
    if (!options.explain_table.empty()) {
      table_.emplace(options.explain_table).out() << simulate::explained_header(model);
    }
    const bool is_wanted =
        options.is_explained || table_ || !options.picture.empty() || view_.is_wanted();
    if (!is_wanted) return;
    explainer_.emplace(
        model,
        [this](const simulate::ExplainedBlock& block) {
          if (table_) table_->out() << simulate::to_csv(block, model_);
        },
        [this](const simulate::ExplainedCycle& cycle) {
          if (!options_.picture.empty()) picture_.add(cycle);
          const auto cause =
              cycle.cause ? static_cast<std::uint8_t>(*cycle.cause) : panel::RunView::kUndecided;
          cause_ = {cycle.programmed_mm_per_s, cycle.limit, cause, cycle.tool_length_mm};
        },
        [this](simulate::Cause cause) { view_.decide(static_cast<std::uint8_t>(cause)); });
  }

  [[nodiscard]] simulate::Explainer* explainer() { return explainer_ ? &*explainer_ : nullptr; }

  /// Every cycle that is sent, after what was said of it.
  void add(const CycleRecord& record) { view_.add(record.setpoint, cause_); }

  /// Writes what was asked for; a message where that fails.
  [[nodiscard]] std::string finish(const simulate::SimulateReport& report, const ToolTable& tools) {
    if (const std::string lost = view_.write(tools, words(report)); !lost.empty()) return lost;
    if (options_.is_explained) std::cout << to_text(explainer_->explanation(), model_);
    if (table_ && !table_->commit()) return options_.explain_table + ": cannot be written";
    if (options_.picture.empty()) return "";
    const std::string title =
        std::filesystem::path(options_.file).filename().string() + ", machine " + model_.name;
    const auto error = picture_.draw(options_.picture, title);
    return error ? error->text() : "";
  }

 private:
  [[nodiscard]] panel::RunView::Words words(const simulate::SimulateReport& report) const {
    panel::RunView::Words out;
    out.title = std::filesystem::path(options_.file).filename().string() + ", " + model_.name;
    for (std::size_t i = 0; i < simulate::limit_count(model_); ++i) {
      out.limits.push_back(simulate::name_of(static_cast<simulate::LimitId>(i), model_));
    }
    if (!report.reason.empty()) out.findings.push_back(report.reason);
    out.summary = to_text(report, model_);
    if (explainer_) out.summary += to_text(explainer_->explanation(), model_);
    return out;
  }

  const Options& options_;
  const MachineModel& model_;
  simulate::FeedPicture picture_;
  ViewFile view_;
  panel::RunView::Cause cause_;
  std::optional<text::WholeFile> table_;
  std::optional<simulate::Explainer> explainer_;
};

/// What is in the way of a file, as JSON; it is not run.
int print_findings(const Options& options, cl::ClReaderOptions& reading, const MachineModel& model,
                   ToolTable& tools) {
  if (!can_be_read_twice(options.file)) return refuse("--json needs a file, not a pipe");
  const stream::PreflightReport report =
      read_through(options.file, reading, options.machine, model, tools);
  std::cout << "{\"file\": " << text::json_quoted(options.file)
            << ", \"is_refused\": " << (report.is_refused ? "true" : "false")
            << ",\n\"findings\": " << to_json(report.findings) << "}\n";
  return report.is_refused ? kInputRefused : kFine;
}

int exit_code_of(simulate::Outcome outcome) {
  switch (outcome) {
    case simulate::Outcome::kDone:
      return kFine;
    case simulate::Outcome::kRefused:
      return kInputRefused;
    default:
      return kVerdictNo;
  }
}

/// What the run that is replayed was cut with; --tools goes first.
void take_recorded_tools(const Options& options, const simulate::OperatorEvents& events,
                         MachineModel& model, ToolTable& tools) {
  if (!options.machine.tools.empty()) return;
  if (events.tools) tools = *events.tools;
  const bool is_reported = !events.feed_marks.empty() && events.feed_marks.front().is_begin;
  const double length_mm = is_reported ? events.feed_marks.front().tool_length_mm : 0;
  if (length_mm > 0) model.tool_length_mm = length_mm;
}

int run(const Options& options) {
  MachineModel model = load_machine(options.machine);
  if (options.pole_policy == "ease") model.pole_policy = PolePolicy::kRelax;
  if (options.pole_policy == "exact") model.pole_policy = PolePolicy::kExact;
  if (options.override_ramp_s > 0) model.override_ramp_s = options.override_ramp_s;
  ToolTable tools = load_tools(options.machine);
  simulate::SimulateOptions simulation;
  simulation.settings = settings_of(options.join);
  simulation.settings.retracts_first = options.cl.first_line > 0;
  const SmoothSettings& settings = simulation.settings;
  const std::string refusal =
      stream::refusal_of_tolerances(model, settings.transition.value_or(model.transition),
                                    settings.tip_tolerance_mm, settings.axis_tolerance_rad);
  if (!refusal.empty()) return refuse(options.machine.machine + ": " + refusal);
  simulation.stops_at_optional = options.stops_at_optional;
  simulation.has_action_peer = options.auxiliary == "ignore";
  if (!options.events.empty()) {
    std::ifstream file(options.events, std::ios::binary);
    if (!file) return refuse(options.events + ": cannot be opened");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    auto events = simulate::read_operator_events(text, options.events, model.max_feed_override);
    if (!events) return refuse(events.error());
    simulation.events = std::move(*events);
    const auto& frame = simulation.events.frame;
    if (frame && options.machine.frame.empty()) {
      stream::place_frame(model, frame->rotation, frame->origin_mm);
    }
    if (simulation.events.limits)
      shrink_travel(model, travel_under(*simulation.events.limits, model));
    take_recorded_tools(options, simulation.events, model, tools);
  }
  if (!options.start_from.empty()) {
    const auto drives = first_drives(options.start_from, model);
    if (!drives) return refuse(drives.error().text());
    simulation.start = *drives;
  }
  std::ifstream file;
  std::istream* const input = open_cl_file(options.file, file);
  if (input == nullptr) return refuse(options.file + ": cannot be opened");
  cl::ClReaderOptions reading = reader_options(options.cl, options.machine, model);
  if (options.gives_findings) return print_findings(options, reading, model, tools);
  if (!pass_file(options.file, reading, options.machine, model, tools)) return kInputRefused;
  cl::ClReader reader(*input, options.file, reading);
  std::optional<record::RecordingWriter> writer;
  const std::string lost = text::refusal_to_write(
      {options.file, options.events, options.start_from, options.machine.machine,
       options.machine.tools},
      {options.record, options.explain_table, options.picture, options.html});
  if (!lost.empty()) return refuse(lost);
  if (!options.record.empty()) {
    auto created = record::RecordingWriter::create(options.record, model);
    if (!created) return refuse(created.error().text());
    writer.emplace(std::move(*created));
  }
  Explaining explaining(options, model);
  simulation.explainer = explaining.explainer();
  std::optional<certify::Certifier> certifier;
  if (options.is_certified) simulation.certifier = &certifier.emplace(model);
  const simulate::SimulateReport report =
      simulate::simulate(reader, options.file, model, tools, simulation,
                         [&writer, &explaining](const CycleRecord& row) {
                           if (writer) (void)writer->write(row);
                           explaining.add(row);
                         });
  if (!can_be_read_twice(options.file)) print_warnings(options.file, reader.warnings());
  std::cout << to_text(report, model);
  if (const std::string failure = explaining.finish(report, tools); !failure.empty())
    return refuse(failure);
  if (writer && !writer->close()) {
    return refuse(options.record + ": " + std::strerror(writer->error_number()));
  }
  const int exit_code = exit_code_of(report.outcome);
  if (!certifier) return exit_code;
  std::cout << to_text(certifier->certificate(), model);
  return exit_code == kFine && !certifier->certificate().is_given() ? kVerdictNo : exit_code;
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "simulate",
      "A CL file through planner and cycle as the service runs it, without DDS and clock: "
      "traversal "
      "time, nearest limits, recording. Actions (tool, spindle, coolant) are done at once");
  add_cl_file(*command, options->file);
  add_machine_options(*command, options->machine, true);
  command->add_option("-r,--record", options->record, "Write every cycle to this recording (CSV)");
  command->add_flag("--explain", options->is_explained,
                    "Show where the time went: by limit and cause, and the blocks that cost most");
  command->add_option("--explain-table", options->explain_table,
                      "Write the same of every block to this table (CSV)");
  command->add_option("--picture", options->picture,
                      "Draw the feed, programmed and achieved, and what held it to this .png or "
                      ".svg");
  add_view_option(*command, options->html);
  command->add_flag("--certify", options->is_certified,
                    "Prove that the plan keeps every limit between its setpoints too; exit code 1 "
                    "where it does not, or where that could not be decided");
  command->add_option(
      "--events", options->events,
      "Replay operator events: rows cycle,verb,argument, as the service writes them "
      "beside its recording (docs/recordings.md)");
  command->add_option("--start-from", options->start_from,
                      "Start where the drives were enabled in this recording "
                      "instead of the machine's home");
  command
      ->add_option("--auxiliary", options->auxiliary,
                   "Action words: ignore (done at once), refuse (as a service without action peer)")
      ->check(CLI::IsMember({"ignore", "refuse"}))
      ->capture_default_str();
  add_join_options(*command, options->join);
  command
      ->add_option("--pole-policy", options->pole_policy,
                   "Instead of the machine file's: ease (inside the axis tolerance) or exact")
      ->check(CLI::IsMember({"ease", "exact"}));
  command
      ->add_option("--override-ramp-s", options->override_ramp_s,
                   "Instead of the machine file's: time of the override from 100 % to 0")
      ->check(finite_range(1.0, 1000.0));
  command->add_flag("--json", options->gives_findings,
                    "Print what is in the way of the file as JSON (words, tools, reach, travel), "
                    "and do not run it");
  command->add_flag("--optional-stops", options->stops_at_optional, "Optional stops stop");
  add_cl_file_options(*command, options->cl);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli::simulate_command
