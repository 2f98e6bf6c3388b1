// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/programs/surface/patch_file.hpp"
#include "service/programs/surface/sample_part.hpp"
#include "service/programs/surface/surface_path.hpp"
#include "service/programs/surface/surface_picture.hpp"
#include "service/programs/surface/surface_program.hpp"
#include "service/programs/surface/surface_report.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::cli::surface_command {
namespace {

struct Options {
  std::string patch, sample, output, picture, wrist_points;
  std::size_t points = 0, lines = 0;
  double chord_error_mm = 0, scallop_mm = 0, wrist_distance_mm = 0;
};

int refuse(const std::string& message) {
  std::cerr << "meridian surface: " << message << "\n";
  return kInputRefused;
}

/// Writes the CL file where it belongs: to --output or standard output.
int put(const Options& options, const std::string& program) {
  if (options.output.empty()) {
    std::cout << program;
    return kFine;
  }
  return text::write_whole(options.output, program) ? kFine
                                                    : refuse(options.output + " cannot be written");
}

/// The spacings of the command line instead of the file's.
void override_spacing(const Options& options, surface::CoverOptions& cover) {
  if (options.points > 0 || options.chord_error_mm > 0) {
    cover.points = options.points;
    cover.chord_error_mm = options.chord_error_mm;
  }
  if (options.lines > 0 || options.scallop_mm > 0) {
    cover.lines = options.lines;
    cover.scallop_mm = options.scallop_mm;
  }
}

int make_path(const Options& options) {
  surface::PatchJob job = surface::load_patch(options.patch);
  override_spacing(options, job.cover);
  const auto path = surface::cover(job.rule, job.cover);
  if (!path) return refuse(options.patch + ": " + path.error().what + "; " + path.error().remedy);
  std::ostringstream program;
  surface::write_program(job, *path, std::filesystem::path(options.patch).filename().string(),
                         program);
  if (const int code = put(options, program.str()); code != kFine) return code;
  std::vector<surface::WristPoint> wrists;
  if (options.wrist_distance_mm > 0)
    wrists = surface::wrist_points(*path, options.wrist_distance_mm);
  if (!options.wrist_points.empty() && !text::write_whole(options.wrist_points, to_table(wrists))) {
    return refuse(options.wrist_points + " cannot be written");
  }
  if (!options.picture.empty()) {
    if (const auto error = surface::draw(job, *path, wrists, options.picture))
      return refuse(*error);
  }
  const surface::SurfaceReport report = surface::measure(job, *path);
  (options.output.empty() ? std::cerr : std::cout) << to_text(report, job);
  return report.gouges == 0 ? kFine : kVerdictNo;
}

int make_sample(const Options& options) {
  std::ostringstream program;
  surface::write_sample(options.sample, program);
  if (const int code = put(options, program.str()); code != kFine) return code;
  (options.output.empty() ? std::cerr : std::cout) << surface::sample_report(options.sample);
  return kFine;
}

int run(const Options& options) {
  const std::string lost = text::refusal_to_write(
      {options.patch}, {options.output, options.picture, options.wrist_points});
  if (!lost.empty()) return refuse(lost);
  if (options.patch.empty() == options.sample.empty()) {
    std::cerr << "meridian surface: name a patch file, or a part with --sample\n";
    return kUsage;
  }
  return options.sample.empty() ? make_path(options) : make_sample(options);
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "surface",
      "A CL file that covers a NURBS patch (docs/surface.md), with a report: lines, contacts, "
      "curvature, chord error, scallop, gouges. Exit code 1 where the cutter gouges");
  command->add_option("patch", options->patch,
                      "Patch file (TOML), such as "
                      "deploy/parts/reference-patch.toml");
  command->add_option("-o,--output", options->output,
                      "Write the CL file here; else to standard output, the report to standard "
                      "error");
  CLI::Option* const points =
      command
          ->add_option("--points", options->points,
                       "Contacts of each line, even in the parameter; instead of the file's")
          ->check(CLI::Range(2, 100000));
  command
      ->add_option("--chord-error-mm", options->chord_error_mm,
                   "Largest distance of the path from the surface; instead of the file's")
      ->check(finite_range(1e-6, 1e3))
      ->excludes(points);
  CLI::Option* const lines = command
                                 ->add_option("--lines", options->lines,
                                              "Lines, even in the parameter; instead of the file's")
                                 ->check(CLI::Range(2, 100000));
  command
      ->add_option("--scallop-mm", options->scallop_mm,
                   "Largest height of a cusp between lines; instead of the file's")
      ->check(finite_range(1e-6, 1e3))
      ->excludes(lines);
  command->add_option("--picture", options->picture,
                      "Draw patch, path, curvature and chord error to this .png or .svg");
  CLI::Option* const distance =
      command
          ->add_option("--wrist-distance", options->wrist_distance_mm,
                       "From the contact S to a robot's wrist along the normal N, mm: draws the "
                       "points S + dN in the picture")
          ->check(finite_range(1e-3, 1e4));
  command
      ->add_option("--wrist-points", options->wrist_points,
                   "Write these points and N as a table, x_mm,y_mm,z_mm,i,j,k")
      ->needs(distance);
  command->add_option("--sample", options->sample, "Instead: a sample part by its name")
      ->check(CLI::IsMember(surface::sample_names()));
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli::surface_command
