// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "service/panel/motion.hpp"
#include "service/panel/serve/news.hpp"
#include "service/panel/status/auxiliaries.hpp"
#include "service/transport/convert/messages.hpp"

/// What the page is told, as JSON texts; their members are listed in docs/panel.md.
namespace meridian::panel {

/// {"t":"frame", ...}: one status, with tip and tool axis by forward() and what `motion` gathered.
/// `auxiliaries` is what is asked of spindle and coolant.
[[nodiscard]] std::string frame_text(const dds::Status& status, const MachineModel& model,
                                     const Motion& motion, const Auxiliaries& auxiliaries = {});

/// The same without anything that takes kinematics, of which `names` has none.
[[nodiscard]] std::string bare_frame_text(const dds::Status& status, const MachineModel& names,
                                          const Auxiliaries& auxiliaries = {});

/// {"t":"news", "items": [...]}
[[nodiscard]] std::string news_text(const News& news);

/// {"t":"machine", "scene": ..., "host": ..., "version": ...}; `scene` is describe_scene().
[[nodiscard]] std::string machine_text(const dds::MachineInfo& machine, const std::string& scene);

/// {"t":"silent"}: no service speaks for this machine any more.
[[nodiscard]] std::string silent_text();

}  // namespace meridian::panel
