// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/daemon/ports/drive_sources.hpp"
#include "service/recording/telemetry/words.hpp"

namespace meridian::interpolator {

/// Says once what changed among those who report drives: who has which, who is gone, who reports
/// what is another one's, both by name, and whose drives obey another service. What it remembers is
/// bounded by the slots of DriveSources. Proof:
/// tests/unit/daemon/source_reporter_test.cpp.
class SourceReporter {
 public:
  using Say = std::function<void(telemetry::Weight, const std::string&)>;
  /// Where a writer runs, in words; asked for while it is matched.
  using NameOf = std::function<std::string(std::uint64_t)>;

  /// Everybody else who writes drive commands, in words.
  using CommandersOf = std::function<std::string()>;

  explicit SourceReporter(const MachineModel& model, std::uint64_t service_id = 0)
      : model_(model), service_id_(service_id) {}

  void look(const DriveSources& sources, std::int64_t now_ns, const NameOf& name_of,
            const CommandersOf& commanders, const Say& say);

 private:
  struct Known {
    std::uint64_t writer = 0;
    std::uint32_t group = 0;
    std::string name;  ///< "drive group 0 of process 4711 on host mill3"
    std::uint32_t bound_mask = 0;
    std::uint32_t contested_mask = 0;
    std::uint64_t master = 0;  ///< other service that its drives obey; 0: none
    bool is_here = false;
    bool is_guard_lost = false;
  };

  Known& know(const DriveSource& source, const NameOf& name_of, const Say& say);
  void report_bound(Known& known, const DriveSource& source, const Say& say) const;
  void report_master(Known& known, const DriveSource& source, const CommandersOf& commanders,
                     const Say& say) const;
  void report_contest(Known& known, const DriveSource& source, const DriveSources& sources,
                      std::int64_t now_ns, const Say& say) const;
  static void report_guard(Known& known, const DriveSource& source, std::int64_t now_ns,
                           const Say& say);
  [[nodiscard]] std::string known_name(const DriveSource& source) const;

  const MachineModel& model_;
  std::uint64_t service_id_;
  std::vector<Known> known_;
  bool is_full_reported_ = false;
};

}  // namespace meridian::interpolator
