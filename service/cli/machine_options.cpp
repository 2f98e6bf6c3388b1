// SPDX-License-Identifier: Apache-2.0
#include "service/cli/machine_options.hpp"

#include "service/config/machine_file.hpp"

namespace meridian::cli {

void add_machine_options(CLI::App& command, MachineOptions& options, bool has_workpiece) {
  command.add_option("-m,--machine", options.machine, "Machine file (TOML)")->required();
  if (!has_workpiece) return;
  command.add_option("--frame", options.frame,
                     "Where the workpiece lies: x,y,z[,a,b,c] in mm and deg, Rz(c) Ry(b) Rx(a); "
                     "instead of the machine file's frame");
  command.add_option("--tools", options.tools, "Tool table (TOML) for programs that call tools");
}

MachineModel load_machine(const MachineOptions& options) {
  MachineModel model = config::load_machine(options.machine);
  if (!options.frame.empty()) {
    config::place_workpiece(model, config::parse_frame(options.frame));
  }
  return model;
}

ToolTable load_tools(const MachineOptions& options) {
  return options.tools.empty() ? ToolTable() : config::load_tools(options.tools);
}

cl::ClReaderOptions reader_options(const ClFileOptions& file, const MachineModel& model) {
  cl::ClReaderOptions out = reader_options(file);
  if (model.default_unit_mm) out.default_unit = cl::LengthUnit::kMillimetre;
  if (model.default_unit_inch) out.default_unit = cl::LengthUnit::kInch;
  out.max_feed_mm_per_s = model.max_feed_mm_per_s;
  return out;
}

}  // namespace meridian::cli
