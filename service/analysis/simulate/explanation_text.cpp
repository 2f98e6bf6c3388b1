// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>

#include "meridian/units.hpp"
#include "service/analysis/simulate/explanation.hpp"
#include "service/text/printed.hpp"

namespace meridian::simulate {
namespace {

using text::append;
using text::Count;

/// A row of the table by limit and cause.
struct Row {
  LimitId limit;
  Cause cause;
  Explanation::Share share;
};

void append_shares(std::string& out, const Explanation& explanation, const MachineModel& model) {
  constexpr double kMinShare = 0.002;  // of the time: below it a row says nothing
  std::vector<Row> rows;
  Row others{kNoLimit, Cause::kPath, {}};
  for (std::size_t limit = 0; limit < kLimitIds; ++limit) {
    for (std::size_t cause = 0; cause < kCauses; ++cause) {
      const Explanation::Share& share = explanation.shares[limit][cause];
      if (share.time_s > kMinShare * explanation.time_s) {
        rows.push_back({static_cast<LimitId>(limit), static_cast<Cause>(cause), share});
      } else {
        others.share.time_s += share.time_s;
        others.share.lost_s += share.lost_s;
      }
    }
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return a.share.lost_s > b.share.lost_s; });
  out += "held by                 why           lost s     time s   of the time\n";
  const auto append_row = [&](const std::string& limit, const char* cause, const Row& row) {
    append(out, "%-22s  %-9s %10.3f %10.3f %9.1f %%\n", limit.c_str(), cause, row.share.lost_s,
           row.share.time_s, 100 * row.share.time_s / explanation.time_s);
  };
  for (const Row& row : rows) append_row(name_of(row.limit, model), name_of(row.cause), row);
  if (others.share.time_s > 0) append_row("others", "", others);
}

[[nodiscard]] const char* name_of(BlockKind kind) {
  switch (kind) {
    case BlockKind::kCut:
      return "cut";
    case BlockKind::kRapid:
      return "rapid";
    case BlockKind::kDwell:
      return "dwell";
    case BlockKind::kAuxiliary:
      return "action";
    case BlockKind::kTool:
      return "tool";
    case BlockKind::kStop:
    case BlockKind::kOptionalStop:
      return "stop";
    case BlockKind::kEnd:
      return "end";
  }
  return "";
}

}  // namespace

std::string to_text(const Explanation& explanation, const MachineModel& model) {
  std::string out;
  append(out, "explained  %.3f s, %llu cycles, %llu blocks; %.3f s more than at the feed\n",
         explanation.time_s, static_cast<Count>(explanation.cycles),
         static_cast<Count>(explanation.blocks), explanation.lost_s);
  if (explanation.cycles == 0) return out;
  append_shares(out, explanation, model);
  if (explanation.worst.empty()) return out;
  out +=
      "lines                blocks    lost s    time s  mm/min: feed     mean    least  held by, "
      "why\n";
  for (const ExplainedStretch& stretch : explanation.worst) {
    char lines[32];
    if (stretch.first_line == stretch.last_line) {
      std::snprintf(lines, sizeof lines, "%u", stretch.first_line);
    } else {
      std::snprintf(lines, sizeof lines, "%u-%u", stretch.first_line, stretch.last_line);
    }
    append(out, "%-17s %9llu %9.3f %9.3f %13.0f %8.0f %8.0f  %s, %s\n", lines,
           static_cast<Count>(stretch.blocks), stretch.lost_s, stretch.time_s,
           units::per_min_from_per_s(stretch.programmed_mm_per_s),
           units::per_min_from_per_s(stretch.distance_mm / stretch.time_s),
           units::per_min_from_per_s(stretch.min_mm_per_s), name_of(stretch.limit, model).c_str(),
           name_of(stretch.cause));
  }
  return out;
}

std::string explained_header(const MachineModel& model) {
  std::string out =
      "sequence,line,kind,length_mm,programmed_mm_per_min,mean_mm_per_min,min_mm_per_min,time_s,"
      "lost_s,held_by,why,deviation_deg";
  for (std::size_t id = 0; id < limit_count(model); ++id) {
    std::string name = name_of(static_cast<LimitId>(id), model);
    std::replace(name.begin(), name.end(), ' ', '_');
    out += ",share_" + name;
  }
  for (std::size_t cause = 0; cause < kCauses; ++cause) {
    out += std::string(",why_") + name_of(static_cast<Cause>(cause));
  }
  return out + "\n";
}

std::string to_csv(const ExplainedBlock& block, const MachineModel& model) {
  std::string out;
  append(out, "%llu,%u,%s,%.6f,%.3f,%.3f,%.3f,%.6f,%.6f,", static_cast<Count>(block.sequence),
         block.line, name_of(block.kind), block.length_mm,
         units::per_min_from_per_s(block.programmed_mm_per_s),
         units::per_min_from_per_s(block.mean_mm_per_s()),
         units::per_min_from_per_s(block.min_mm_per_s), block.time_s, block.lost_s);
  out += name_of(block.main_limit(), model) + "," + name_of(block.main_cause());
  append(out, ",%.6f", units::deg_from_rad(block.relaxed_rad));
  const double whole = std::max(block.time_s, 1e-300);
  for (std::size_t id = 0; id < limit_count(model); ++id) {
    append(out, ",%.3g", static_cast<double>(block.by_limit[id]) / whole);
  }
  for (const float cause : block.by_cause) append(out, ",%.3g", static_cast<double>(cause) / whole);
  return out + "\n";
}

}  // namespace meridian::simulate
