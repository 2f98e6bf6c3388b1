// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/view_option.hpp"

#include "service/text/whole_file.hpp"

namespace meridian::cli {

void add_view_option(CLI::App& command, std::string& file) {
  command.add_option("--html", file,
                     "Write the run as one page that opens in a browser without a network: the "
                     "machine, its path, feed and limits over time, findings");
}

ViewFile::ViewFile(const MachineModel& model, const std::string& name) : name_(name) {
  if (!name.empty()) view_.emplace(model);
}

std::string ViewFile::write(const ToolTable& tools, const panel::RunView::Words& words) const {
  if (!view_) return "";
  const std::string page = view_->html(tools, words);
  if (page.empty()) {
    return name_ +
           ": this build has no page; install npm and libcivetweb-dev and build again "
           "(docs/panel.md)";
  }
  return text::write_whole(name_, page) ? "" : name_ + ": cannot be written";
}

}  // namespace meridian::cli
