// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/interpreter/copies.hpp"

#include <algorithm>

namespace meridian::cl {
namespace {

std::string name_of(std::uint32_t number) { return "INDEX/" + std::to_string(number); }

}  // namespace

void Copies::record(const Statement& s) {
  if (patterns_.empty() || is_repeating()) return;
  if (s.source == Statement::Source::kCatiaMatrix ||
      text_.size() + s.major.size() + s.rest.size() > kMaxText) {
    lose_all();
    return;
  }
  Record record{text_.size(), 0, s.source};
  text_.append(s.major);
  if (!s.major.empty()) text_.push_back('/');
  text_.append(s.rest);
  record.size = text_.size() - record.begin;
  records_.push_back(record);
}

void Copies::lose_all() {
  text_.clear();
  records_.clear();
  for (Pattern& pattern : patterns_) pattern.is_lost = true;
}

Copies::Pattern* Copies::find(std::uint32_t number) {
  const auto at = std::find_if(patterns_.begin(), patterns_.end(),
                               [number](const Pattern& p) { return p.number == number; });
  return at == patterns_.end() ? nullptr : &*at;
}

Outcome Copies::begin_pattern(std::uint32_t number, const Start& start, std::uint32_t line) {
  if (is_repeating()) return {};
  if (const Pattern* const before = find(number)) {
    return refuse(name_of(number) + " stands in line " + std::to_string(before->line) + " too",
                  "give every pattern a number of its own");
  }
  patterns_.push_back({number, line, start, records_.size(), {}, false});
  return {};
}

Outcome Copies::end_pattern(std::uint32_t number) {
  if (is_repeating()) return {};
  Pattern* const pattern = find(number);
  if (pattern == nullptr) return refuse(name_of(number) + ",NOMORE without " + name_of(number));
  pattern->end = here();
  return {};
}

Outcome Copies::repeat(std::uint32_t number, const Frame& step, std::uint32_t times,
                       const Start& now, std::uint32_t line) {
  const Pattern* const pattern = find(number);
  if (pattern == nullptr) {
    return refuse("COPY without " + name_of(number) + " before it");
  }
  const std::string from = name_of(number) + " (line " + std::to_string(pattern->line) + ")";
  if (pattern->is_lost) {
    return refuse("COPY: the pattern from " + from + " is too long to repeat, or its frame changes",
                  "let the CAM system write the repeated motion out");
  }
  if (now.is_in_cycle != pattern->start.is_in_cycle) {
    return refuse("COPY: a cycle is in force at " + std::string(now.is_in_cycle ? "COPY" : from) +
                      " and not at " + (now.is_in_cycle ? from : "COPY"),
                  "CYCLE/OFF inside the pattern, or after COPY");
  }
  const std::size_t end = pattern->end.value_or(here());
  if (end <= pattern->begin) return refuse("COPY: there is nothing between it and " + from);
  if (passes_.size() == kMaxDepth) return refuse("COPY inside of COPY, more than eight deep");
  given_ += std::uint64_t{end - pattern->begin} * times;
  if (given_ > kMaxStatements) {
    return refuse("COPY: more than ten million statements come of the patterns of this file",
                  "split the file");
  }
  const std::uint32_t outermost = passes_.empty() ? line : passes_.front().line;
  passes_.push_back(
      {pattern->begin, end, pattern->begin, step, step, times, outermost, pattern->start});
  return {};
}

RecordedStatement Copies::next() {
  Pass& pass = passes_.back();
  const Record& record = records_[pass.at++];
  return {std::string_view(text_).substr(record.begin, record.size), pass.line, record.source};
}

bool Copies::go_on() {
  bool has_changed = false;
  while (is_repeating() && passes_.back().at == passes_.back().end) {
    Pass& pass = passes_.back();
    has_changed = true;
    if (--pass.left == 0) {
      passes_.pop_back();
      continue;
    }
    pass.at = pass.begin;
    pass.now = compose(pass.now, pass.step);
  }
  return has_changed;
}

Frame Copies::transformation() const {
  Frame all;
  for (const Pass& pass : passes_) all = compose(all, pass.now);
  return all;
}

}  // namespace meridian::cl
