// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/segments.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace meridian::soak {
namespace {

/// Rows of Ready, Off or Fault after a program that end its segment.
constexpr int kRestRows = 50;

[[nodiscard]] std::string_view cell(std::string_view line, std::size_t column) {
  for (; column > 0; --column) {
    const auto comma = line.find(',');
    if (comma == std::string_view::npos) return {};
    line.remove_prefix(comma + 1);
  }
  return line.substr(0, line.find(','));
}

[[nodiscard]] std::size_t column_of(const std::string& header, const char* name) {
  const std::string before = header.substr(0, header.find(name));
  return static_cast<std::size_t>(std::count(before.begin(), before.end(), ',')) + 1;
}

[[nodiscard]] bool is_at_rest(std::string_view state) {
  return state == "off" || state == "ready" || state == "fault" || state == "enabling" ||
         state == "disabling" || state == "loaded";
}

}  // namespace

Segments::Segments(std::filesystem::path folder, Report report)
    : folder_(std::move(folder)), report_(std::move(report)) {}

void Segments::add(std::string_view text) {
  rest_ += text;
  std::size_t begin = 0;
  for (auto end = rest_.find('\n'); end != std::string::npos; end = rest_.find('\n', begin)) {
    add_line(std::string_view(rest_).substr(begin, end - begin));
    begin = end + 1;
  }
  rest_.erase(0, begin);
}

void Segments::add_line(std::string_view line) {
  if (line.starts_with("cycle,")) {
    end_segment(true);
    header_ = line;
    state_column_ = column_of(header_, ",state");
    due_column_ = column_of(header_, ",due_ns");
    epoch_column_ = column_of(header_, ",epoch");
    return;
  }
  if (header_.empty()) return;
  const std::string_view state = cell(line, state_column_);
  if (!file_.is_open()) {
    segment_.file = folder_ / ("segment" + std::to_string(count_++) + ".csv");
    file_.open(segment_.file, std::ios::trunc);
    file_ << header_ << '\n';
  }
  file_ << line << '\n';
  ++segment_.rows;
  const bool rests = is_at_rest(state);
  if (!rests && !segment_.has_run) {
    segment_.has_run = true;
    epoch_ = cell(line, epoch_column_);
    segment_.begin_ns = std::atoll(std::string(cell(line, due_column_)).c_str());
  }
  segment_.is_aborted = segment_.is_aborted || state == "aborting" || state == "fault_stop" ||
                        state == "fault" ||
                        (segment_.has_run && cell(line, epoch_column_) != epoch_);
  rest_rows_ = rests ? rest_rows_ + 1 : 0;
  if (segment_.has_run && rest_rows_ >= kRestRows) end_segment(false);
}

void Segments::end_segment(bool is_cut_off) {
  if (!file_.is_open()) return;
  file_.close();
  segment_.is_aborted = segment_.is_aborted || is_cut_off;
  report_(std::exchange(segment_, {}));
  rest_rows_ = 0;
}

void Segments::cut_off() {
  rest_.clear();  // the row that was being written
  end_segment(true);
}

}  // namespace meridian::soak
