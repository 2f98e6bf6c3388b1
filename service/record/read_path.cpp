// SPDX-License-Identifier: Apache-2.0
#include "service/record/read_path.hpp"

#include <fstream>

#include "service/cl/cl_reader.hpp"

namespace meridian::record {

std::string read_path(const std::string& file, const cl::ClReaderOptions& options,
                      const ToolTable& tools, CheckedPath& path,
                      std::vector<cl::ClWarning>* warnings) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return file + ": cannot be opened";
  cl::ClReader reader(in, file, options);
  for (;;) {
    const auto block = reader.next();
    if (!block) return block.error().text();
    if (!*block) {
      if (warnings != nullptr) *warnings = reader.warnings();
      return "";
    }
    double tool_length_mm = 0;
    if ((*block)->kind == BlockKind::kTool) {
      const Tool* tool = tools.find(static_cast<int>((*block)->value));
      if (tool == nullptr) {
        return file + ":" + std::to_string((*block)->line) +
               ": the tool is not in the tool table; name one with --tools";
      }
      tool_length_mm = tool->length_mm;
    }
    path.add(**block, tool_length_mm);
  }
}

}  // namespace meridian::record
