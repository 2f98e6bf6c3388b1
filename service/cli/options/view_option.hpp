// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "service/panel/program/run_view.hpp"

namespace meridian::cli {

/// Adds --html, the run as one page, to `command`.
void add_view_option(CLI::App& command, std::string& file);

/// The page that --html asks for; without a name nothing happens.
class ViewFile {
 public:
  ViewFile(const MachineModel& model, const std::string& name);

  [[nodiscard]] bool is_wanted() const noexcept { return view_.has_value(); }
  void add(const Setpoint& setpoint, const panel::RunView::Cause& cause) {
    if (view_) view_->add(setpoint, cause);
  }
  /// The cause of the newest cycles, as far back as they have none.
  void decide(std::uint8_t cause) noexcept {
    if (view_) view_->decide(cause);
  }
  /// Writes the file; a message where that fails.
  [[nodiscard]] std::string write(const ToolTable& tools, const panel::RunView::Words& words) const;

 private:
  std::string name_;
  std::optional<panel::RunView> view_;
};

}  // namespace meridian::cli
