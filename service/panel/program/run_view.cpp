// SPDX-License-Identifier: Apache-2.0
#include "service/panel/program/run_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "service/panel/json_text.hpp"
#include "service/panel/page.hpp"
#include "service/panel/scene.hpp"

namespace meridian::panel {
namespace {

using nlohmann::json;

/// What stands in the page where the run goes.
constexpr std::string_view kMarker = "MERIDIAN_REPORT";

[[nodiscard]] double rounded(double value, double step) { return std::round(value / step) * step; }

/// `value` as JSON that ends no script of the page it lies in.
[[nodiscard]] std::string embeddable(const json& value) {
  std::string text = json_text(value);
  std::string out;
  out.reserve(text.size());
  for (const char letter : text) {
    if (letter == '<') {
      out += "\\u003c";
    } else {
      out += letter;
    }
  }
  return out;
}

}  // namespace

RunView::RunView(const MachineModel& model)
    : model_(model), motion_(model, std::numeric_limits<int>::max()) {
  samples_.reserve(kMaxSamples);
}

void RunView::add(const Setpoint& setpoint, const Cause& cause) {
  if (has_begun_ && cause.tool_length_mm != tool_length_mm_) {
    tip_ = forward(model_, cause.tool_length_mm, *motion_.joints()).tip;  // another tool is no path
  }
  tool_length_mm_ = cause.tool_length_mm;
  motion_.add(setpoint);
  if (!motion_.joints()) return;
  const Pose<double> pose = forward(model_, cause.tool_length_mm, *motion_.joints());
  if (!has_begun_) {
    has_begun_ = true;
    first_cycle_ = kept_cycle_ = setpoint.cycle;
    tip_ = pose.tip;
    return keep(setpoint, cause, pose);
  }
  path_mm_ += (pose.tip - tip_).norm();
  tip_ = pose.tip;
  if (++since_ < every_) return;
  keep(setpoint, cause, pose);
  if (samples_.size() >= kMaxSamples) halve();
}

void RunView::keep(const Setpoint& setpoint, const Cause& cause, const Pose<double>& pose) {
  const double period_s = static_cast<double>(model_.cycle_ns) * 1e-9;
  Sample sample;
  sample.time_s = period_s * static_cast<double>(setpoint.cycle - first_cycle_);
  sample.joints = *motion_.joints();
  sample.pose = pose;
  const double passed_s = period_s * static_cast<double>(setpoint.cycle - kept_cycle_);
  sample.feed_mm_per_s = passed_s > 0 ? path_mm_ / passed_s : 0;
  sample.line = setpoint.line;
  sample.cause = cause;
  for (std::size_t i = 0; i < sample.shares.size(); ++i) {
    const auto& of = motion_.shares()[i];
    sample.shares[i] = static_cast<float>(*std::max_element(of.begin(), of.end()));
  }
  samples_.push_back(sample);
  motion_.clear();
  kept_cycle_ = setpoint.cycle;
  path_mm_ = 0;
  since_ = 0;
}

void RunView::decide(std::uint8_t cause) noexcept {
  for (auto sample = samples_.rbegin(); sample != samples_.rend(); ++sample) {
    if (sample->cause.cause != kUndecided) return;
    sample->cause.cause = cause;
  }
}

/// Every other sample goes; the next one takes its shares and its path.
void RunView::halve() {
  std::size_t kept = 1;
  for (std::size_t i = 2; i < samples_.size(); i += 2) {
    Sample sample = samples_[i];
    const Sample& gone = samples_[i - 1];
    const double before = samples_[kept - 1].time_s;
    const double path_mm = sample.feed_mm_per_s * (sample.time_s - gone.time_s) +
                           gone.feed_mm_per_s * (gone.time_s - before);
    sample.feed_mm_per_s = path_mm / (sample.time_s - before);
    for (std::size_t k = 0; k < sample.shares.size(); ++k) {
      sample.shares[k] = std::max(sample.shares[k], gone.shares[k]);
    }
    samples_[kept++] = sample;
  }
  samples_.resize(kept);
  every_ *= 2;
}

std::string RunView::html(const ToolTable& tools, const Words& words) const {
  const std::string_view page = viewer_html();
  const std::size_t marker = page.find(kMarker);
  if (marker == std::string_view::npos) return "";
  json columns = {{"time", json::array()},       {"line", json::array()},  {"feed", json::array()},
                  {"programmed", json::array()}, {"limit", json::array()}, {"cause", json::array()},
                  {"tool", json::array()},       {"tip", json::array()},   {"axis", json::array()},
                  {"joints", json::array()},     {"shares", json::array()}};
  const int count = model_.joint_count;
  for (const Sample& sample : samples_) {
    columns["time"].push_back(rounded(sample.time_s, 1e-5));
    columns["line"].push_back(sample.line);
    columns["feed"].push_back(rounded(sample.feed_mm_per_s * 60, 1e-2));
    columns["programmed"].push_back(rounded(sample.cause.programmed_mm_per_s * 60, 1e-2));
    columns["limit"].push_back(sample.cause.limit);
    columns["cause"].push_back(sample.cause.cause);
    columns["tool"].push_back(rounded(sample.cause.tool_length_mm, 1e-6));
    for (std::size_t i = 0; i < 3; ++i) {
      columns["tip"].push_back(rounded(sample.pose.tip[i], 1e-5));
      columns["axis"].push_back(rounded(sample.pose.axis[i], 1e-6));
    }
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      columns["joints"].push_back(rounded(sample.joints[at], 1e-7));
      columns["shares"].push_back(rounded(static_cast<double>(sample.shares[at]), 1e-4));
    }
  }
  const json report = {
      {"title", words.title},     {"scene", json::parse(describe_scene(model_, tools))},
      {"limits", words.limits},   {"findings", words.findings},
      {"summary", words.summary}, {"columns", std::move(columns)}};
  std::string out(page.substr(0, marker));
  out += embeddable(report);
  out += page.substr(marker + kMarker.size());
  return out;
}

}  // namespace meridian::panel
