// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "service/recording/trace/trace_text.hpp"

namespace meridian::trace {
namespace {

using Json = nlohmann::json;

/// Whether `time` is µs from zero on in whole nanoseconds.
[[nodiscard]] bool is_time(const Json& time) {
  if (!time.is_number()) return false;
  const double ns = time.get<double>() * 1e3;
  return ns >= 0 && std::fabs(ns - std::nearbyint(ns)) < 1e-3;
}
[[nodiscard]] std::int64_t ns_of(const Json& time) {
  return std::llround(time.get<double>() * 1e3);
}

/// Checks a trace by the rules of the Trace Event Format, and by what Perfetto makes of those that
/// it leaves open: times from zero on, slices of a thread in their order and properly nested,
/// threads that are named before their first slice, no key that nobody reads.
class Format {
 public:
  [[nodiscard]] static std::vector<std::string> violations(const std::string& text) {
    const Json trace = Json::parse(text, nullptr, false);
    if (!trace.is_object()) return {"no JSON object"};
    Format format;
    format.check_frame(trace);
    if (!trace.contains("traceEvents") || !trace["traceEvents"].is_array()) {
      return {"no array traceEvents"};
    }
    for (const Json& event : trace["traceEvents"]) format.check(event);
    format.expect(format.process_names_ == 1, "one process_name");
    return format.found_;
  }

 private:
  void expect(bool is_so, const std::string& rule) {
    if (!is_so) found_.push_back("event " + std::to_string(index_) + ": " + rule);
  }

  void check_frame(const Json& trace) {
    static const std::set<std::string> kKeys{"traceEvents", "displayTimeUnit", "otherData"};
    for (const auto& [key, value] : trace.items()) expect(kKeys.contains(key), "key " + key);
    const Json unit = trace.value("displayTimeUnit", Json());
    expect(unit == "ms" || unit == "ns", "displayTimeUnit is ms or ns");
    expect(trace.value("otherData", Json::object()).is_object(), "otherData is an object");
  }

  void check(const Json& event) {
    ++index_;
    if (!event.is_object()) return expect(false, "an object");
    const auto is_text = [&event](const char* key) {
      return event.contains(key) && event[key].is_string() && !event[key].empty();
    };
    expect(is_text("name"), "a name");
    expect(event.contains("pid") && event["pid"].is_number_integer(), "an integer pid");
    expect(!event.contains("args") || event["args"].is_object(), "args are an object");
    const std::string phase = event.value("ph", "");
    static const std::map<std::string, std::set<std::string>> kKeys{
        {"X", {"name", "cat", "ph", "pid", "tid", "ts", "dur", "args"}},
        {"i", {"name", "cat", "ph", "pid", "tid", "ts", "s", "args"}},
        {"M", {"name", "ph", "pid", "tid", "args"}}};
    const auto keys = kKeys.find(phase);
    if (keys == kKeys.end()) return expect(false, "ph is X, i or M");
    for (const auto& [key, value] : event.items()) {
      expect(keys->second.contains(key), "key " + key + " of " + phase);
    }
    if (phase == "M") return check_metadata(event);
    expect(is_text("cat"), "a category");
    expect(event.contains("ts") && is_time(event["ts"]), "ts from zero on, in whole ns");
    const Json tid = event.value("tid", Json());
    expect(tid.is_number_integer() && named_.contains(tid.get<int>()), "tid of a named thread");
    if (phase == "i") {
      const std::string scope = event.value("s", "");
      expect(scope == "g" || scope == "p" || scope == "t", "scope is g, p or t");
    } else if (event.contains("dur") && is_time(event["dur"]) && found_.empty()) {
      check_nesting(tid.get<int>(), ns_of(event["ts"]), ns_of(event["dur"]));
    } else {
      expect(event.contains("dur") && is_time(event["dur"]), "dur from zero on, in whole ns");
    }
  }

  void check_metadata(const Json& event) {
    const std::string name = event.value("name", "");
    const Json args = event.value("args", Json::object());
    const bool is_thread = name == "thread_name" || name == "thread_sort_index";
    expect(is_thread || name == "process_name", "metadata of a known name");
    expect(args.size() == 1, "one argument");
    if (name == "thread_sort_index") {
      expect(args.contains("sort_index") && args["sort_index"].is_number_integer(), "sort_index");
    } else {
      expect(args.contains("name") && args["name"].is_string(), "args.name");
    }
    if (name == "process_name") ++process_names_;
    if (!is_thread) return;
    const Json tid = event.value("tid", Json());
    if (!tid.is_number_integer()) return expect(false, "an integer tid");
    if (name == "thread_name") expect(named_.insert(tid.get<int>()).second, "one name a thread");
    expect(!open_.contains(tid.get<int>()), "metadata before the slices of its thread");
  }

  /// A slice begins no sooner than the one before it, and lies inside what it begins in.
  void check_nesting(int tid, std::int64_t begin_ns, std::int64_t took_ns) {
    std::vector<std::int64_t>& ends = open_[tid];
    std::int64_t& before_ns = begun_.try_emplace(tid, 0).first->second;
    expect(begin_ns >= before_ns, "slices of a thread in their order");
    before_ns = begin_ns;
    while (!ends.empty() && ends.back() <= begin_ns) ends.pop_back();
    expect(ends.empty() || begin_ns + took_ns <= ends.back(), "slices nest");
    ends.push_back(begin_ns + took_ns);
  }

  int index_ = 0, process_names_ = 0;
  std::set<int> named_;
  std::map<int, std::vector<std::int64_t>> open_;
  std::map<int, std::int64_t> begun_;
  std::vector<std::string> found_;
};

constexpr std::int64_t kBegin_ns = 5'000'000'000'123, kPeriod_ns = 1'000'000;

/// Ten cycles, the one of number `long_cycle` computing for `took_ns`, and who works beside them.
[[nodiscard]] Window window_of(int long_cycle, std::int64_t took_ns) {
  Window window{.slow = {.cycle = 5, .due_ns = kBegin_ns + 5 * kPeriod_ns, .late_ns = 7},
                .begin_ns = kBegin_ns,
                .end_ns = kBegin_ns + 10 * kPeriod_ns,
                .machine = "la\"i\n",
                .service_version = "1.0",
                .host = "h\\ost"};
  auto& cycles = window.spans[static_cast<std::size_t>(Track::kCycle)];
  std::int64_t free_ns = 0;
  for (int i = 0; i < 10; ++i) {
    const auto add = [&](Doing doing, std::int64_t begin_ns, std::int64_t end_ns) {
      cycles.push_back({begin_ns, static_cast<std::uint64_t>(i),
                        static_cast<std::int32_t>(end_ns - begin_ns), doing});
      free_ns = end_ns;
    };
    const std::int64_t due_ns = kBegin_ns + i * kPeriod_ns;
    if (due_ns + kPeriod_ns < free_ns) continue;  // lost
    add(Doing::kWakeUp, due_ns, std::max(due_ns + 20'001, free_ns));
    add(Doing::kGather, free_ns, free_ns + 999);
    add(Doing::kStep, free_ns, free_ns + (i == long_cycle ? took_ns : 3'000));
    add(Doing::kWakeOther, free_ns, free_ns + 2'000);
    add(Doing::kShow, free_ns, free_ns + 1'000);
  }
  window.spans[static_cast<std::size_t>(Track::kPlanner)] = {
      {kBegin_ns - 700'000'000, 4, 701'000'000, Doing::kWaitForRoom},
      {kBegin_ns + 1'000'000, 4, 500'000, Doing::kPlan}};
  window.spans[static_cast<std::size_t>(Track::kPublisher)] = {
      {kBegin_ns + 30'000, 0, 20'000, Doing::kWrite}};
  return window;
}

constexpr const char* kPlain = R"({"displayTimeUnit": "ns", "otherData": {}, "traceEvents": [
{"name": "process_name", "ph": "M", "pid": 1, "args": {"name": "p"}},
{"name": "thread_name", "ph": "M", "pid": 1, "tid": 1, "args": {"name": "t"}},
{"name": "a", "cat": "c", "ph": "X", "pid": 1, "tid": 1, "ts": 1.000, "dur": 5.000, "args": {}},
{"name": "b", "cat": "c", "ph": "X", "pid": 1, "tid": 1, "ts": 2.000, "dur": 4.000, "args": {}},
{"name": "f", "cat": "c", "ph": "i", "s": "g", "pid": 1, "tid": 1, "ts": 3.000}]})";

/// The check above, checked: each of these is one slip away from what is right.
TEST(TraceFormat, CatchesEveryRuleThatIsBroken) {
  ASSERT_EQ(Format::violations(kPlain), std::vector<std::string>{});
  struct Slip {
    const char *right, *wrong, *rule;
  };
  for (const Slip& slip : std::vector<Slip>{{"\"ns\"", "\"us\"", "displayTimeUnit"},
                                            {"traceEvents", "events", "traceEvents"},
                                            {"\"ph\": \"X\"", "\"ph\": \"B\"", "ph is"},
                                            {"\"pid\": 1", "\"pid\": \"1\"", "pid"},
                                            {"\"name\": \"a\", ", "", "a name"},
                                            {"\"cat\": \"c\", ", "", "category"},
                                            {"\"ts\": 1.000", "\"ts\": -1.000", "ts from zero"},
                                            {"\"ts\": 1.000", "\"ts\": 1.0005", "ts from zero"},
                                            {"\"ts\": 1.000, ", "", "ts from zero"},
                                            {", \"dur\": 5.000", "", "dur from zero"},
                                            {"\"dur\": 5.000", "\"dur\": -5", "dur from zero"},
                                            {"\"dur\": 4.000", "\"dur\": 4.001", "nest"},
                                            {"\"ts\": 2.000", "\"ts\": 0.500", "order"},
                                            {"\"s\": \"g\"", "\"s\": \"x\"", "scope"},
                                            {"\"tid\": 1, \"ts\"", "\"tid\": 2, \"ts\"", "named"},
                                            {"thread_name", "thread_nick", "known name"},
                                            {"\"args\": {}", "\"arg\": {}", "key arg"},
                                            {"process_name", "thread_name", "one process_name"}}) {
    std::string text = kPlain;
    text.replace(text.find(slip.right), std::string(slip.right).size(), slip.wrong);
    const auto found = Format::violations(text);
    EXPECT_TRUE(std::any_of(
        found.begin(), found.end(),
        [&](const std::string& one) { return one.find(slip.rule) != std::string::npos; }))
        << slip.wrong << ": " << (found.empty() ? "nothing found" : found.front());
  }
}

TEST(TraceFormat, IsKeptByAWindow) {
  EXPECT_EQ(Format::violations(to_json(window_of(-1, 0))), std::vector<std::string>{});
  EXPECT_EQ(Format::violations(to_json(Window{})), std::vector<std::string>{});
}

TEST(TraceFormat, IsKeptWhereACycleComputesForLongerThanItsPeriod) {
  for (const std::int64_t took_ns : {1'400'000, 2'000'000, 3'700'000}) {
    EXPECT_EQ(Format::violations(to_json(window_of(3, took_ns))), std::vector<std::string>{});
  }
}

TEST(TraceFormat, ShowsWhatHadBegunBeforeTheWindow) {
  const Json trace = Json::parse(to_json(window_of(-1, 0)));
  EXPECT_EQ(trace["otherData"]["begin_ns"], kBegin_ns - 700'000'000);
  const auto& events = trace["traceEvents"];
  const auto wait = std::find_if(events.begin(), events.end(),
                                 [](const Json& one) { return one["name"] == "wait for room"; });
  ASSERT_NE(wait, events.end());
  EXPECT_EQ((*wait)["ts"], 0.0);
  EXPECT_EQ((*wait)["dur"], 701'000.0);
}

}  // namespace
}  // namespace meridian::trace
