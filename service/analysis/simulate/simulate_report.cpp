// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/simulate_report.hpp"

#include <algorithm>
#include <utility>

#include "meridian/cycle/state_table.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "service/text/printed.hpp"

namespace meridian::simulate {

using text::append;
using text::Count;

namespace {

constexpr const char* kRateNames[] = {"velocity", "acceleration", "jerk"};

void append_shares(std::string& text, const LimitShares& shares, const MachineModel& model) {
  std::vector<std::pair<std::uint64_t, std::string>> all{{shares.feed, "feed"},
                                                         {shares.none, "none above half"}};
  for (int i = 0; i < limited_count(model); ++i) {
    for (int order = 0; order < 3; ++order) {
      all.emplace_back(shares.joints[i][order],
                       limited_spec(model, i).name + " " + kRateNames[order]);
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  text += "limited by";
  const char* separator = " ";
  for (const auto& [cycles, what] : all) {
    const double share = static_cast<double>(cycles) / static_cast<double>(shares.cycles);
    if (share < 0.01) break;
    append(text, "%s%s %.0f %%", separator, what.c_str(), 100 * share);
    separator = ", ";
  }
  text += "\n";
}

void append_rewinds(std::string& text, const SimulateReport& report, const MachineModel& model) {
  constexpr std::size_t kMaxReported = 12;
  append(text, "rewind     %llu times\n", static_cast<Count>(report.rewind_count));
  const std::size_t shown = std::min(kMaxReported, report.rewinds.size());
  for (std::size_t n = 0; n < shown; ++n) {
    const Rewind& one = report.rewinds[n];
    const char* const redundant = model.joints[redundant_joint(model)].name.c_str();
    append(text, "  line %u: %s would leave its travel; %s from %.3f deg by ", one.line,
           limited_spec(model, one.joint).name.c_str(), redundant,
           units::deg_from_rad(one.from_rad));
    if (one.is_other_branch()) {
      append(text, "%+.3f deg to the other branch", units::deg_from_rad(one.turn_rad));
    } else {
      append(text, "%+d turns", one.turns);
    }
    append(text, ", %.6g mm off\n", one.retract_mm);
  }
  if (report.rewind_count > shown) {
    append(text, "  and %llu more\n", static_cast<Count>(report.rewind_count - shown));
  }
}

/// The stretches that were relaxed, the farthest first where there are many.
void append_relaxed_axes(std::string& text, const SimulateReport& report) {
  constexpr std::size_t kMaxReported = 12;
  append(text, "pole       axis relaxed in %llu stretches, at most %.4f deg\n",
         static_cast<Count>(report.relaxed_count),
         units::deg_from_rad(report.largest_deviation_rad));
  std::vector<RelaxedAxis> shown = report.relaxed_axes;
  if (shown.size() > kMaxReported) {
    std::stable_sort(shown.begin(), shown.end(), [](const RelaxedAxis& a, const RelaxedAxis& b) {
      return a.deviation_rad > b.deviation_rad;
    });
    shown.resize(kMaxReported);
  }
  for (const RelaxedAxis& relaxed_axis : shown) {
    append(text, "  lines %u to %u: %.4f deg, %s\n", relaxed_axis.first_line,
           relaxed_axis.last_line, units::deg_from_rad(relaxed_axis.deviation_rad),
           name_of(relaxed_axis.reason));
  }
  if (report.relaxed_count > shown.size()) {
    append(text, "  and %llu more\n", static_cast<Count>(report.relaxed_count - shown.size()));
  }
}

void append_happening(std::string& text, const Happening& happening) {
  const Event& event = happening.event;
  append(text, "  cycle %llu: ", static_cast<Count>(happening.cycle));
  if (event.code == EventCode::kStateChanged) {
    append(text, "%s -> %s\n", name_of(static_cast<State>(event.b)),
           name_of(static_cast<State>(event.a)));
  } else if (event.code == EventCode::kRefused) {
    append(text, "%s refused: %s\n", name_of(static_cast<Verb>(event.b)),
           name_of(static_cast<Refusal>(event.x)));
  } else if (event.code == EventCode::kAccepted) {
    append(text, "%s accepted\n", name_of(static_cast<Verb>(event.b)));
  } else {
    append(text, "alarm %llu, joint %llu, value %.6g, line %u\n", static_cast<Count>(event.a),
           static_cast<Count>(event.b), event.x, event.line);
  }
}

[[nodiscard]] const char* word(Outcome outcome) {
  switch (outcome) {
    case Outcome::kDone:
      return "DONE";
    case Outcome::kStopped:
      return "STOPPED by the operator";
    case Outcome::kRefused:
      return "REFUSED";
    case Outcome::kStarved:
      return "STARVED: the blocks ended without the end of the program";
    case Outcome::kFault:
      return "FAULT";
  }
  return "";
}

}  // namespace

std::string to_text(const SimulateReport& report, const MachineModel& model) {
  std::string text;
  append(text, "program    %s: %llu blocks, %llu of motion, %.3f mm of cuts, %.3f mm of rapids\n",
         report.name.c_str(), static_cast<Count>(report.blocks),
         static_cast<Count>(report.motion_blocks), report.cut_length_mm, report.rapid_length_mm);
  if (report.feeds_limited > 0) {
    append(text, "           %llu blocks were programmed above the machine's highest feed\n",
           static_cast<Count>(report.feeds_limited));
  }
  append(text, "time       %.3f s, after an approach of %.3f s; %.3f s of it waiting\n",
         report.program_s, report.approach_s, report.waiting_s);
  if (report.vertex_stops_s > 0) {
    append(text, "           exact stop: at least %.3f s of %.3f s are stops at vertices\n",
           report.vertex_stops_s, report.program_s);
  }
  append(text, "           the cuts alone at the programmed feed: %.3f s\n", report.at_feed_s);
  if (report.shares.cycles > 0) append_shares(text, report.shares, model);
  if (report.relaxed_count > 0) append_relaxed_axes(text, report);
  if (report.rewind_count > 0) append_rewinds(text, report, model);
  append(text, "cycles     %llu of %.6g ms, computed in %.2f s\n",
         static_cast<Count>(report.cycles), report.cycle_s * 1e3, report.computing_s);
  if (!report.happenings.empty()) text += "events\n";
  for (const Happening& happening : report.happenings) append_happening(text, happening);
  if (report.happenings_dropped > 0) {
    append(text, "  and %llu more\n", static_cast<Count>(report.happenings_dropped));
  }
  text += word(report.outcome);
  if (!report.reason.empty()) text += ": " + report.reason;
  return text + "\n";
}

}  // namespace meridian::simulate
