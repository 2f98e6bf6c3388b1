// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "meridian/units.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/machine_options.hpp"
#include "service/cli/options/view_option.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/programs/cl/foreign.hpp"
#include "service/programs/proof/program_check.hpp"
#include "service/programs/proof/tip_program.hpp"
#include "service/protocol/frame_sum.hpp"
#include "service/recording/record/check/check.hpp"
#include "service/recording/record/check/compare.hpp"
#include "service/recording/record/file/read_path.hpp"
#include "service/recording/record/file/recorded/operator_events_writer.hpp"
#include "service/recording/record/file/recorded/recorded_frame.hpp"
#include "service/recording/record/file/recorded/recorded_limits.hpp"
#include "service/recording/record/file/recorded/recorded_tools.hpp"
#include "service/recording/record/picture/picture.hpp"

namespace meridian::cli::check_command {
namespace {

struct Options {
  std::string recording, file, picture, html, program_dialect;
  std::vector<std::string> same;
  double tip_tolerance_mm = 0, axis_tolerance_deg = 0;
  bool is_json = false, is_feed_factor_given = false;
  record::CheckOptions check;
  MachineOptions machine;
  std::optional<ToolTable> tools;  ///< that the recording holds
  ClFileOptions cl;
};

int refuse(const std::string& message) {
  std::cerr << message << "\n";
  return kInputRefused;
}

int compare(const Options& options, const MachineModel& model) {
  auto a = record::RecordingReader::open(options.same[0], model);
  if (!a) return refuse(a.error().text());
  auto b = record::RecordingReader::open(options.same[1], model);
  if (!b) return refuse(b.error().text());
  const auto report = record::compare(*a, *b, model);
  if (!report) return refuse(report.error().text());
  std::cout << to_text(*report, options.same[0], options.same[1], model);
  return report->is_same() ? kFine : kVerdictNo;
}

/// The overrides of the run, where its recorder wrote the operator's events beside the recording.
void find_overrides(Options& options, const MachineModel& model) {
  std::ifstream file(record::operator_events_path(options.recording), std::ios::binary);
  if (!file) return;
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (auto overrides = record::read_feed_overrides(text)) {
    options.check.overrides = std::move(*overrides);
  } else {
    options.check.feed_factor = model.max_feed_override;
  }
}

/// The recording as a page, with what was found; a message where that fails.
[[nodiscard]] std::string write_view(const Options& options, const MachineModel& model,
                                     const ToolTable& tools, const record::CheckedPath& path,
                                     const record::CheckReport& report,
                                     record::RecordingReader& recording) {
  ViewFile view(model, options.html);
  if (!view.is_wanted()) return "";
  recording.rewind();
  record::RecordingRow row;
  for (;;) {
    const auto read = recording.next(row);
    if (!read) return read.error().text();
    if (!*read) break;
    Setpoint setpoint{.cycle = row.cycle, .due_ns = row.due_ns};
    setpoint.position = drives_at(model, row.positions);
    setpoint.line = row.line;
    setpoint.flags = row.flags;
    view.add(setpoint, {.tool_length_mm = path.begin_tool_length_mm()});
  }
  panel::RunView::Words words;
  words.title = options.recording + ", " + model.name;
  words.limits = {"not known from a recording"};
  words.summary = to_text(report);
  for (const record::Finding& finding : report.findings) {
    std::string text = finding.text;
    if (finding.line > 0) text += " (line " + std::to_string(finding.line) + ")";
    words.findings.push_back(std::move(text));
  }
  return view.write(tools, words);
}

int check(Options& options, const MachineModel& model) {
  ToolTable tools = options.tools ? *options.tools : load_tools(options.machine);
  record::CheckedPath path(model.tool_length_mm, model.max_feed_mm_per_s);
  if (!options.file.empty()) {
    cl::ClReaderOptions reading = reader_options(options.cl, options.machine, model);
    add_unknown_tools(options.file, reading, options.machine, tools);
    describe_machine(reading, model, tools, load_tool_names(options.machine));
    std::vector<cl::ClWarning> warnings;
    const std::string refusal = record::read_path(options.file, reading, tools, path, &warnings);
    print_warnings(options.file, warnings);
    if (!refusal.empty()) return refuse(refusal);
  }
  auto recording = record::RecordingReader::open(options.recording, model);
  if (!recording) return refuse(recording.error().text());
  if (!options.picture.empty()) {
    const auto error = record::draw(
        *recording, path, model, std::filesystem::path(options.file).filename(), options.picture);
    if (error) return refuse(error->text());
  }
  if (!options.is_feed_factor_given) find_overrides(options, model);
  options.check.tip_tolerance_mm = options.tip_tolerance_mm;
  options.check.axis_tolerance_rad = units::rad_from_deg(options.axis_tolerance_deg);
  auto report = record::check(*recording, path, model, options.check);
  if (!report) return refuse(report.error().text());
  report->path_name = options.file;
  const std::string lost = write_view(options, model, tools, path, *report, *recording);
  if (!lost.empty()) return refuse(lost);
  std::cout << (options.is_json ? to_json(*report) : to_text(*report));
  return report->passed() ? kFine : kVerdictNo;
}

[[nodiscard]] std::string head_of(const std::string& file) {
  constexpr std::size_t kHead = 64 * 1024;
  std::ifstream in(file, std::ios::binary);
  std::string head(kHead, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  return head;
}

using Blocks = Expected<std::vector<ClBlock>, std::string>;

/// Every block of a file that pass_file() let through.
[[nodiscard]] Blocks blocks_of(const std::string& name, const cl::ClReaderOptions& reading) {
  std::ifstream file(name, std::ios::binary);
  cl::ClReader reader(file, name, reading);
  std::vector<ClBlock> blocks;
  for (;;) {
    const auto block = reader.next();
    if (!block) {
      return tl::make_unexpected(name + ":" + std::to_string(block.error().line) + ": " +
                                 block.error().message);
    }
    if (!*block) return blocks;
    blocks.push_back(**block);
  }
}

using Steps = Expected<std::vector<proof::ProgramStep>, std::string>;

[[nodiscard]] Steps steps_of_joint_words(const std::string& name, const MachineModel& model) {
  std::ifstream program(name, std::ios::binary);
  auto steps = proof::read_joint_program(program, model);
  if (steps) return std::move(*steps);
  return tl::make_unexpected(name + ":" + std::to_string(steps.error().line) + ": " +
                             steps.error().message);
}

/// The words of a control that keeps the tip: which they are, or nothing.
[[nodiscard]] std::optional<cl::Dialect> tip_dialect(const Options& options) {
  if (options.program_dialect == "joints") return std::nullopt;
  if (!options.program_dialect.empty()) return cl::find_dialect(options.program_dialect);
  const cl::Recognised what = cl::recognise_foreign(head_of(options.recording));
  if (what.program == cl::Dialect::kUnknown) return std::nullopt;
  return what.program;
}

/// An empty message: pass_file() has said on standard error why.
[[nodiscard]] Steps steps_of_tip_words(const Options& options, cl::Dialect dialect,
                                       const MachineModel& model, ToolTable& tools) {
  cl::ClReaderOptions reading = reader_options(options.cl, options.machine, model);
  reading.dialect = dialect;
  MachineModel fine = model;
  fine.tolerances.axis_rad *= proof::kFinerTurns;
  if (!pass_file(options.recording, reading, options.machine, fine, tools)) {
    return tl::make_unexpected(std::string());
  }
  const Blocks blocks = blocks_of(options.recording, reading);
  if (!blocks) return tl::make_unexpected(blocks.error());
  return proof::steps_of_tip(*blocks);
}

/// A posted program in place of a recording.
int check_program(const Options& options, const MachineModel& model) {
  if (options.file.empty()) return refuse("meridian check: name the CL file of the program");
  ToolTable tools = load_tools(options.machine);
  cl::ClReaderOptions reading = reader_options(options.cl, options.machine, model);
  if (!pass_file(options.file, reading, options.machine, model, tools)) return kInputRefused;
  const Blocks blocks = blocks_of(options.file, reading);
  if (!blocks) return refuse(blocks.error());
  const auto dialect = tip_dialect(options);
  const Steps steps = dialect ? steps_of_tip_words(options, *dialect, model, tools)
                              : steps_of_joint_words(options.recording, model);
  if (!steps) return steps.error().empty() ? kInputRefused : refuse(steps.error());
  proof::ProgramReport report = proof::check_program(
      *steps, *blocks, model, tools,
      {options.tip_tolerance_mm, units::rad_from_deg(options.axis_tolerance_deg)});
  report.program = options.recording;
  report.path_name = options.file;
  std::cout << (options.is_json ? to_json(report) : to_text(report));
  return report.passed() ? kFine : kVerdictNo;
}

/// Where the workpiece lay, under which soft limits and with which tools it was cut, as the
/// recorder wrote it beside the recording; --frame and --tools go first.
void find_set_up(Options& options, MachineModel& model) {
  if (options.recording.empty()) return;
  std::ifstream file(record::operator_events_path(options.recording), std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (const auto frame = record::find_recorded_frame(text);
      frame && options.machine.frame.empty()) {
    stream::place_frame(model, frame->rotation, frame->origin_mm);
  }
  options.check.soft_limits = record::find_all_limits(text);
  if (!options.machine.tools.empty()) return;
  options.tools = record::find_recorded_tools(text);
  if (const auto length_mm = record::find_recorded_tool_length(text)) {
    model.tool_length_mm = *length_mm;
  }
}

int run(Options& options) {
  MachineModel model = load_machine(options.machine);
  find_set_up(options, model);
  if (!options.same.empty()) return compare(options, model);
  if (options.recording.empty()) {
    std::cerr << "meridian check: name a recording, or two after --same\n";
    return kUsage;
  }
  const std::string head = head_of(options.recording);
  const bool is_program = !options.program_dialect.empty() || proof::is_nc_program(head) ||
                          cl::recognise_foreign(head).is_nc;
  if (is_program) return check_program(options, model);
  return check(options, model);
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "check",
      "A recording checked against its CL file by forward kinematics, and against the limits of "
      "the "
      "machine; an NC program, run as its control would, against its CL file; "
      "or two recordings compared bit for bit. Exit code 1 where anything is wrong");
  command->add_option("recording", options->recording, "Recording (CSV), or NC program");
  command->add_option("file", options->file,
                      "CL file that it cut; without one only joints and cycles are checked");
  add_machine_options(*command, options->machine, true);
  command
      ->add_option("--same", options->same,
                   "Instead: do these two recordings hold the same motion, bit for bit on every "
                   "cycle that both sent?")
      ->expected(2)
      ->type_name("A B");
  command
      ->add_option("--tip-tolerance-mm", options->tip_tolerance_mm, "Instead of the machine file's")
      ->check(finite_positive());
  command
      ->add_option("--axis-tolerance-deg", options->axis_tolerance_deg,
                   "Instead of the machine file's")
      ->check(finite_positive());
  command->add_option("--max-missing", options->check.max_missing, "Cycles that may be missing")
      ->capture_default_str();
  CLI::Option* const factor = command->add_option("--feed-factor", options->check.feed_factor,
                                                  "Highest feed override of the run, 1 is 100 %, "
                                                  "instead of those in the .events.csv beside the "
                                                  "recording");
  factor->check(finite_range(0.01, 10.0))->capture_default_str();
  command->add_flag("--unfinished", options->check.allow_unfinished,
                    "The run was ended before its path was");
  command->add_option("--from-cycle", options->check.from_cycle, "Leave out the cycles before");
  command->add_option("--to-cycle", options->check.to_cycle, "Leave out later cycles");
  command->add_option("--picture", options->picture,
                      "Draw tip path, joints, speeds and rates to this .png or .svg");
  add_view_option(*command, options->html);
  command
      ->add_option("--program-dialect", options->program_dialect,
                   "Words of the NC program, where it does not show them: joints, or those of a "
                   "control that keeps the tip")
      ->check(CLI::IsMember({"joints", "fanuc", "siemens", "heidenhain"}));
  command->add_flag("--json", options->is_json, "The report as JSON");
  add_cl_file_options(*command, options->cl);
  command->callback([options, factor, &exit_code] {
    options->is_feed_factor_given = factor->count() > 0;
    exit_code = run(*options);
  });
}

}  // namespace meridian::cli::check_command
