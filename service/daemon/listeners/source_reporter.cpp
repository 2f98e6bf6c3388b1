// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/source_reporter.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <utility>

#include "service/daemon/listeners/feedback_merge.hpp"

namespace meridian::interpolator {

using telemetry::Weight;

std::string SourceReporter::known_name(const DriveSource& source) const {
  for (const Known& known : known_) {
    if (known.writer == source.writer && known.group == source.group) return known.name;
  }
  return fmt::format("drive group {}", source.group);
}

SourceReporter::Known& SourceReporter::know(const DriveSource& source, const NameOf& name_of,
                                            const Say& say) {
  const auto found = std::find_if(known_.begin(), known_.end(), [&source](const Known& known) {
    return known.writer == source.writer && known.group == source.group;
  });
  if (found != known_.end()) return *found;
  Known known;
  known.writer = source.writer;
  known.group = source.group;
  known.name = fmt::format("drive group {} of {}", source.group, name_of(source.writer));
  if (source.has_only_stop) {
    say(Weight::kNews, known.name + " reports a stop input and no drive");
  } else if (source.claimed_mask == 0) {
    say(Weight::kWarning, known.name +
                              " reports no drive that this machine has: nothing of it counts but "
                              "its stop input and guard");
  }
  return known_.emplace_back(std::move(known));
}

void SourceReporter::report_bound(Known& known, const DriveSource& source, const Say& say) const {
  const std::uint32_t news = source.bound_mask & ~known.bound_mask;
  known.bound_mask = source.bound_mask;
  if (news == 0) return;
  say(Weight::kNews,
      fmt::format("{} reports {}", known.name, telemetry::drive_names(news, model_)));
}

void SourceReporter::report_master(Known& known, const DriveSource& source,
                                   const CommandersOf& commanders, const Say& say) const {
  const bool is_other = source.joints() != 0 && source.master != 0 && service_id_ != 0 &&
                        source.master != service_id_;
  const std::uint64_t before = std::exchange(known.master, is_other ? source.master : 0);
  if (before == known.master) return;
  if (known.master == 0) {
    say(Weight::kNews, known.name + " obeys no other service any more");
    return;
  }
  say(Weight::kError,
      fmt::format("{} obeys service {:016x}, not this one ({:016x}): {} cannot be enabled. Drive "
                  "commands are written by {}: end that one",
                  known.name, known.master, service_id_,
                  telemetry::drive_names(source.joints(), model_), commanders()));
}

void SourceReporter::report_contest(Known& known, const DriveSource& source,
                                    const DriveSources& sources, std::int64_t now_ns,
                                    const Say& say) const {
  std::uint32_t mask = 0;
  for (const DriveSource& owner : sources.slots) {
    if (owner.writer == 0) continue;
    const std::uint32_t both = contested(owner, source, now_ns, FeedbackMerge::kSilence_ns);
    mask |= both;
    if ((both & ~known.contested_mask) == 0) continue;
    say(Weight::kError,
        fmt::format(
            "two report {}: {} keeps them; {} is refused, and nothing of it counts but its "
            "stop input and guard. The machine is not enabled while both report: end one of them",
            telemetry::drive_names(both, model_), known_name(owner), known.name));
  }
  const std::uint32_t before = std::exchange(known.contested_mask, mask);
  if (before != 0 && mask == 0) {
    say(Weight::kNews, known.name + " reports no other one's drives any more");
  }
}

void SourceReporter::report_guard(Known& known, const DriveSource& source, std::int64_t now_ns,
                                  const Say& say) {
  const bool is_silent = now_ns - source.arrival_ns > FeedbackMerge::kSilence_ns;
  const bool is_lost = source.guard != GuardInput::kNone && is_silent;
  if (std::exchange(known.is_guard_lost, is_lost) || !is_lost) return;
  say(Weight::kError, known.name +
                          " says nothing any more: its guard counts as open until it does, or "
                          "another one for its group");
}

void SourceReporter::look(const DriveSources& sources, std::int64_t now_ns, const NameOf& name_of,
                          const CommandersOf& commanders, const Say& say) {
  for (Known& known : known_) known.is_here = false;
  for (const DriveSource& source : sources.slots) {
    if (source.writer == 0) continue;
    Known& known = know(source, name_of, say);
    known.is_here = true;
    report_bound(known, source, say);
    report_master(known, source, commanders, say);
    report_guard(known, source, now_ns, say);
  }
  for (Known& known : known_) {
    if (!known.is_here) say(Weight::kNews, known.name + " is gone");
  }
  std::erase_if(known_, [](const Known& known) { return !known.is_here; });
  for (const DriveSource& source : sources.slots) {
    if (source.writer != 0)
      report_contest(know(source, name_of, say), source, sources, now_ns, say);
  }
  if (sources.is_full && !std::exchange(is_full_reported_, true)) {
    say(Weight::kError,
        fmt::format("more than {} sources report drives: of the others nothing counts but the stop "
                    "input and guard",
                    sources.slots.size()));
  }
}

}  // namespace meridian::interpolator
