// SPDX-License-Identifier: Apache-2.0
#include "service/recording/trace/trace_text.hpp"

#include <algorithm>
#include <limits>

#include "service/text/printed.hpp"

namespace meridian::trace {
namespace {

using text::append;
using text::Count;
using text::json_quoted;

constexpr std::array<const char*, kTracks> kTrackNames{"cycle", "publisher", "receive (DDS)",
                                                       "planner", "intake"};

struct Words {
  const char *name, *arg;
};
constexpr std::array<Words, kDoings> kWords{{{"wake-up", "cycle"},
                                             {"gather", "cycle"},
                                             {"step", "cycle"},
                                             {"wake publisher", "cycle"},
                                             {"show", "cycle"},
                                             {"DDS write", "cycle"},
                                             {"plan block", "block"},
                                             {"wait for room", "block"},
                                             {"advance", "block"},
                                             {"take blocks", "blocks queued"},
                                             {"feedback", "cycle seen"}}};

[[nodiscard]] double us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

/// What is zero in the file: viewers drop what begins before it, and a span may have begun before
/// the window.
[[nodiscard]] std::int64_t zero_of(const Window& window) noexcept {
  std::int64_t first_ns = std::min(window.begin_ns, window.slow.due_ns);
  for (const auto& spans : window.spans) {
    for (const Span& span : spans) first_ns = std::min(first_ns, span.begin_ns);
  }
  return first_ns;
}

void append_span(std::string& out, std::int64_t zero_ns, std::size_t track, const Span& span) {
  const Words& words = kWords[static_cast<std::size_t>(span.doing)];
  append(out,
         ",\n{\"name\": \"%s\", \"cat\": \"%s\", \"ph\": \"X\", \"pid\": 1, \"tid\": %zu, "
         "\"ts\": %.3f, \"dur\": %.3f, \"args\": {\"%s\": %llu}}",
         words.name, kTrackNames[track], track + 1, us(span.begin_ns - zero_ns), us(span.took_ns),
         words.arg, Count{span.arg});
}

/// A thread does one thing at a time, and viewers draw slices that overlap wrongly. A wake-up
/// begins when its cycle was due; if the cycle before it still ran then, it begins where that
/// ended.
void append_track(std::string& out, const Window& window, std::int64_t zero_ns, std::size_t track) {
  std::int64_t free_ns = std::numeric_limits<std::int64_t>::min();
  for (const Span& span : window.spans[track]) {
    const std::int64_t end_ns = span.begin_ns + span.took_ns;
    Span shown = span;
    shown.begin_ns = std::max(span.begin_ns, free_ns);
    shown.took_ns = static_cast<std::int32_t>(std::max<std::int64_t>(end_ns - shown.begin_ns, 0));
    free_ns = std::max(free_ns, end_ns);
    append_span(out, zero_ns, track, shown);
  }
}

}  // namespace

std::string describe(const SlowCycle& slow) {
  std::string out;
  append(out, "cycle %llu woke %.1f us late and took %.1f us to compute", Count{slow.cycle},
         us(slow.late_ns), us(slow.computation_ns));
  return out;
}

std::string to_json(const Window& window) {
  const std::int64_t zero_ns = zero_of(window);
  std::string out = "{\"displayTimeUnit\": \"ns\",\n \"otherData\": {\"machine\": ";
  out += json_quoted(window.machine) + ", \"service\": " + json_quoted(window.service_version) +
         ", \"host\": " + json_quoted(window.host) +
         ",\n  \"why\": " + json_quoted(describe(window.slow));
  append(out, ", \"begin_ns\": %lld, \"spans_lost\": %llu},\n \"traceEvents\": [\n",
         static_cast<long long>(zero_ns), Count{window.lost});
  append(out, "{\"name\": \"process_name\", \"ph\": \"M\", \"pid\": 1, \"args\": {\"name\": %s}}",
         json_quoted("meridiand " + window.machine).c_str());
  for (std::size_t track = 0; track < kTracks; ++track) {
    append(out,
           ",\n{\"name\": \"thread_name\", \"ph\": \"M\", \"pid\": 1, \"tid\": %zu, \"args\": "
           "{\"name\": \"%s\"}}"
           ",\n{\"name\": \"thread_sort_index\", \"ph\": \"M\", \"pid\": 1, \"tid\": %zu, "
           "\"args\": {\"sort_index\": %zu}}",
           track + 1, kTrackNames[track], track + 1, track);
  }
  append(
      out,
      ",\n{\"name\": %s, \"cat\": \"slow\", \"ph\": \"i\", \"s\": \"g\", \"pid\": 1, \"tid\": 1, "
      "\"ts\": %.3f, \"args\": {\"cycle\": %llu}}",
      json_quoted("slow: " + describe(window.slow)).c_str(), us(window.slow.due_ns - zero_ns),
      Count{window.slow.cycle});
  for (std::size_t track = 0; track < kTracks; ++track) {
    append_track(out, window, zero_ns, track);
  }
  return out + "]}\n";
}

}  // namespace meridian::trace
