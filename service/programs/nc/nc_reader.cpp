// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/nc_reader.hpp"

#include <memory>

#include "service/programs/nc/nc_program.hpp"

namespace meridian::nc {
namespace {

decltype(cl::ClReaderOptions::nc) reader_with(std::shared_ptr<const MachineAxes> axes,
                                              NamedTools named) {
  return [axes = std::move(axes), named = std::move(named)](
             cl::LineSource& lines, const std::string& name, const cl::ClReaderOptions& options,
             std::string_view reason) -> std::unique_ptr<cl::ProgramSource> {
    return std::make_unique<NcProgram>(lines, name, options, reason, axes, named);
  };
}

}  // namespace

decltype(cl::ClReaderOptions::nc) reader_of_programs() { return reader_with(nullptr, {}); }

decltype(cl::ClReaderOptions::nc) reader_of_programs(const MachineModel& model,
                                                     const ToolTable& tools, NamedTools named) {
  return reader_with(std::make_shared<const MachineAxes>(model, tools), std::move(named));
}

}  // namespace meridian::nc
