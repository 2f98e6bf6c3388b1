// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/listeners/feedback_listener.hpp"

#include "meridian/cycle/joint_masks.hpp"
#include "service/daemon/ports/monotonic.hpp"
#include "service/transport/sources.hpp"

namespace meridian::interpolator {
namespace {

/// Samples that wait to be taken: sources do not hide one another, and a flood grows nothing.
constexpr int kDepth = 64;
constexpr std::int64_t kShow_ns = 50'000'000;

}  // namespace

FeedbackListener::FeedbackListener(dds::Participant& participant, const MachineModel& model,
                                   std::uint64_t service_id, Ports& ports)
    : participant_(participant),
      service_id_(service_id),
      ports_(ports),
      merge_(all_joints(model), service_id),
      reporter_(model, service_id),
      spans_(ports.spans != nullptr ? &ports.spans->receive : nullptr),
      reader_(
          participant, [this](auto& reader) { on_data(reader); }, kDepth) {}

void FeedbackListener::on_data(dds::Reader<dds::DriveFeedback>& reader) noexcept {
  dds::DriveFeedback sample;
  dds::SampleInfo info;
  bool has_news = false;
  const std::int64_t begun_ns = spans_.is_on() ? monotonic_ns() : 0;
  const State state = ports_.state.load(std::memory_order_relaxed);
  const bool is_off = state == State::kOff || state == State::kFault;
  for (std::uint64_t writer = 0; gone_.try_pop(writer);) {
    merge_.forget(writer, monotonic_ns(), is_off);
  }
  while (reader.take(sample, info)) {
    if (!info.is_valid) continue;
    const std::int64_t now_ns = monotonic_ns();
    if (!merge_.take(sample, info.source, now_ns, is_off)) continue;
    has_news = true;
    report(now_ns);
    time_round_trip(sample.cycle_seen, now_ns);
  }
  if (!has_news) return;
  ports_.feedback.store(merge_.feedback());
  ports_.drive_words.store(merge_.words());
  ports_.drive_words_for_status.store(merge_.words());
  ports_.drive_words_for_commands.store(merge_.words());
  if (const std::int64_t now_ns = monotonic_ns(); now_ns - shown_ns_ > kShow_ns) {
    sources_.store(merge_.sources());
    shown_ns_ = now_ns;
  }
  if (!spans_.is_on()) return;
  spans_.write(trace::Doing::kFeedback, begun_ns, monotonic_ns(), merge_.feedback().cycle_seen);
}

void FeedbackListener::report_sources(const SourceReporter::Say& say) {
  sources_.refresh();
  const DriveSources& sources = sources_.latest();
  const std::int64_t now_ns = monotonic_ns();
  for (const DriveSource& source : sources.slots) {
    const bool is_silent = now_ns - source.arrival_ns > FeedbackMerge::kSilence_ns;
    if (source.writer == 0 || !is_silent || reader_.has_source(source.writer)) continue;
    static_cast<void>(gone_.try_push(source.writer));
  }
  master_ = master_of(sources, service_id_, now_ns);
  reporter_.look(
      sources, now_ns,
      [this](std::uint64_t writer) {
        return dds::describe_source(participant_, reader_.handle(), writer);
      },
      [this] { return dds::describe_writers(participant_, "meridian/drive_command"); }, say);
}

/// Telemetry that is held up loses reports: rows then carry an older one, and its cycle says so.
void FeedbackListener::report(std::int64_t now_ns) noexcept {
  const Feedback& feedback = merge_.feedback();
  const DriveWords& words = merge_.words();
  (void)ports_.drive_reports.try_push({.arrival_ns = now_ns,
                                       .cycle_seen = feedback.cycle_seen,
                                       .position = feedback.position,
                                       .statusword = words.statusword,
                                       .error = words.error,
                                       .joint_mask = feedback.joint_mask,
                                       .is_emergency_stop = feedback.emergency_stop});
}

void FeedbackListener::time_round_trip(std::uint64_t cycle, std::int64_t now_ns) noexcept {
  // Drives in several groups answer one after the other: the first to answer a cycle counts. What
  // this service did not send, cycles of one before it too, is no answer.
  const std::int64_t sent_ns = ports_.sent_times.sent_ns(cycle);
  if (sent_ns <= 0 || cycle <= answered_) return;
  answered_ = cycle;
  (void)ports_.round_trips.try_push(narrow_ns(now_ns - sent_ns));
}

}  // namespace meridian::interpolator
