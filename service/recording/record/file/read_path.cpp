// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/read_path.hpp"

#include <fstream>

#include "service/programs/cl/cl_reader.hpp"
#include "service/programs/cl/findings.hpp"

namespace meridian::record {
namespace {

cl::ClError unknown_tool(const std::string& file, const ClBlock& block) {
  const std::string what =
      "tool " + std::to_string(static_cast<long>(block.value)) + " is not in the tool table";
  return {file, block.line, what, "give --tools FILE or --unknown-tool-length MM", what, false};
}

}  // namespace

std::string read_path(const std::string& file, const cl::ClReaderOptions& options,
                      const ToolTable& tools, CheckedPath& path,
                      std::vector<cl::ClWarning>* warnings) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return file + ": cannot be opened";
  cl::ClReader reader(in, file, options);
  cl::Findings findings;
  for (;;) {
    const auto block = reader.next();
    if (!block) {
      findings.add(block.error());
      if (!reader.go_on()) break;
      continue;
    }
    if (!*block) break;
    const Tool* const tool = (*block)->kind == BlockKind::kTool
                                 ? tools.find(static_cast<int>((*block)->value))
                                 : nullptr;
    if ((*block)->kind == BlockKind::kTool && tool == nullptr) {
      findings.add(unknown_tool(file, **block));
      continue;
    }
    if (!findings.is_refused()) path.add(**block, tool != nullptr ? tool->tip_length_mm() : 0);
  }
  if (warnings != nullptr) *warnings = reader.warnings();
  std::string text = to_text(findings.sorted(), file);
  if (!text.empty()) text.pop_back();  // the last line end
  return text;
}

}  // namespace meridian::record
