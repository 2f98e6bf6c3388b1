// SPDX-License-Identifier: Apache-2.0
#include "service/recording/trace/tracer.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <thread>
#include <utility>

namespace meridian::trace {
namespace {

constexpr auto kBetweenLooks = std::chrono::milliseconds(10);
/// Threads report a span when it is over: what began inside the window may still be going on.
constexpr std::int64_t kSettle_ns = 20'000'000;

[[nodiscard]] std::int64_t steady_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

[[nodiscard]] std::int64_t end_of(const Span& span) { return span.begin_ns + span.took_ns; }

}  // namespace

Tracer::Tracer(TraceOptions options, TraceOrigin origin, Rings& rings, Say say)
    : options_(std::move(options)),
      origin_(std::move(origin)),
      rings_(rings),
      say_(std::move(say)),
      files_(options_.folder, options_.max_files),
      slow_cycles_(options_.limits) {}

void Tracer::run(const std::atomic<bool>& is_stopping) noexcept {
  try {
    while (!is_stopping.load(std::memory_order_relaxed)) {
      work(steady_ns());
      std::this_thread::sleep_for(kBetweenLooks);
    }
    work(steady_ns());
    while (pending_) write();
  } catch (const std::exception& error) {
    say_(std::string("no more traces: ") + error.what());
  }
}

void Tracer::work(std::int64_t now_ns) {
  drain(Track::kCycle, rings_.cycle);
  drain(Track::kPublisher, rings_.publisher);
  drain(Track::kReceive, rings_.receive);
  drain(Track::kPlanner, rings_.planner);
  drain(Track::kIntake, rings_.intake);
  if (pending_ && now_ns >= pending_->end_ns + kSettle_ns) write();
  forget(now_ns);
}

void Tracer::drain(Track track, SpanRing& ring) {
  auto& lately = lately_[static_cast<std::size_t>(track)];
  for (Span span; ring.spans.try_pop(span);) {
    lately.push_back(span);
    if (track != Track::kCycle) continue;
    if (const auto slow = slow_cycles_.see(span)) see(*slow);
  }
}

void Tracer::see(const SlowCycle& slow) {
  if (pending_ && slow.due_ns <= pending_->end_ns) {
    if (slow.severity_ns() > pending_->worst.severity_ns()) pending_->worst = slow;
    return;
  }
  if (pending_) {
    if (!worst_later_ || slow.severity_ns() > worst_later_->severity_ns()) worst_later_ = slow;
    return;
  }
  if (!is_wanted(slow)) return;
  pending_ = {slow, slow.due_ns - options_.before_ns, slow.end_ns + options_.after_ns};
}

bool Tracer::is_wanted(const SlowCycle& slow) const {
  const bool is_too_soon = written_ && slow.end_ns < written_->end_ns + options_.every_ns &&
                           slow.severity_ns() < 2 * written_->severity_ns;
  return !is_too_soon && files_.would_keep(slow.severity_ns());
}

void Tracer::forget(std::int64_t now_ns) {
  // A cycle that is held up is reported when it is over: what was before it is wanted then.
  const auto& cycles = lately_[static_cast<std::size_t>(Track::kCycle)];
  const std::int64_t seen_ns = cycles.empty() ? now_ns : std::min(now_ns, end_of(cycles.back()));
  const std::int64_t begin_ns = pending_ ? pending_->begin_ns : seen_ns - options_.before_ns;
  const std::int64_t oldest_ns = std::min(begin_ns, seen_ns - options_.before_ns) - kSettle_ns;
  for (auto& lately : lately_) {
    while (!lately.empty() && end_of(lately.front()) < oldest_ns) lately.pop_front();
  }
}

void Tracer::write() {
  Window window{.slow = pending_->worst,
                .begin_ns = pending_->begin_ns,
                .end_ns = pending_->end_ns,
                .machine = origin_.machine,
                .service_version = origin_.service_version,
                .host = origin_.host};
  for (std::size_t track = 0; track < kTracks; ++track) {
    for (const Span& span : lately_[track]) {
      if (end_of(span) < window.begin_ns || span.begin_ns > window.end_ns) continue;
      window.spans[track].push_back(span);
    }
  }
  for (const SpanRing* ring :
       {&rings_.cycle, &rings_.publisher, &rings_.receive, &rings_.planner, &rings_.intake}) {
    window.lost += ring->lost.load(std::memory_order_relaxed);
  }
  const auto file = files_.add(window.slow.severity_ns(), to_json(window));
  written_ = {window.end_ns, window.slow.severity_ns()};
  pending_.reset();
  say_(file.empty() ? "a trace cannot be written to " + options_.folder.string()
                    : describe(window.slow) + "; trace: " + file.string());
  if (const auto slow = std::exchange(worst_later_, std::nullopt)) see(*slow);
}

std::unique_ptr<Tracer> make_tracer(TraceOptions options, TraceOrigin origin, Rings& rings,
                                    Tracer::Say say, const Tracer::Say& complain) {
  try {
    return std::make_unique<Tracer>(std::move(options), std::move(origin), rings, std::move(say));
  } catch (const std::filesystem::filesystem_error& error) {
    complain(std::string("no traces: ") + error.what());
    return nullptr;
  }
}

}  // namespace meridian::trace
