// SPDX-License-Identifier: Apache-2.0
#include "service/trace/trace_text.hpp"

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

void append_span(std::string& out, const Window& window, std::size_t track, const Span& span) {
  const Words& words = kWords[static_cast<std::size_t>(span.doing)];
  append(out,
         ",\n{\"name\": \"%s\", \"cat\": \"%s\", \"ph\": \"X\", \"pid\": 1, \"tid\": %zu, "
         "\"ts\": %.3f, \"dur\": %.3f, \"args\": {\"%s\": %llu}}",
         words.name, kTrackNames[track], track + 1, us(span.begin_ns - window.begin_ns),
         us(span.took_ns), words.arg, Count{span.arg});
}

}  // namespace

std::string describe(const SlowCycle& slow) {
  std::string out;
  append(out, "cycle %llu woke %.1f us late and took %.1f us to compute", Count{slow.cycle},
         us(slow.late_ns), us(slow.computation_ns));
  return out;
}

std::string to_json(const Window& window) {
  std::string out = "{\"displayTimeUnit\": \"ns\",\n \"otherData\": {\"machine\": ";
  out += json_quoted(window.machine) + ", \"service\": " + json_quoted(window.service_version) +
         ", \"host\": " + json_quoted(window.host) +
         ",\n  \"why\": " + json_quoted(describe(window.slow));
  append(out, ", \"begin_ns\": %lld, \"spans_lost\": %llu},\n \"traceEvents\": [\n",
         static_cast<long long>(window.begin_ns), Count{window.lost});
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
      json_quoted("slow: " + describe(window.slow)).c_str(),
      us(window.slow.due_ns - window.begin_ns), Count{window.slow.cycle});
  for (std::size_t track = 0; track < kTracks; ++track) {
    for (const Span& span : window.spans[track]) append_span(out, window, track, span);
  }
  return out + "]}\n";
}

}  // namespace meridian::trace
