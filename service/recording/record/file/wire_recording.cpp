// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/wire_recording.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "meridian/units.hpp"
#include "service/recording/record/words.hpp"
#include "service/text/printed.hpp"

namespace meridian::record {
namespace {

using text::Count;

/// A cycle number this far back is no late sample: the service was started anew.
constexpr std::uint64_t kRestart = 1000;
constexpr double kFirstEdge_ns = 1000;

[[nodiscard]] double upper_edge_ns(std::size_t bucket) {
  return kFirstEdge_ns * std::exp2(static_cast<double>(bucket + 1) / 4);
}

}  // namespace

Expected<WireWriter, RecordError> WireWriter::create(const std::string& path,
                                                     const MachineModel& model) {
  auto file = CsvFile::create(path);
  if (!file) return tl::make_unexpected(std::move(file.error()));
  std::string header = "cycle,due_ns,line";
  for (int i = 0; i < model.joint_count; ++i) {
    header.append(",").append(position_column(model.joints[i]));
  }
  for (int i = 0; i < model.joint_count; ++i) {
    header.append(",").append(velocity_column(model.joints[i]));
  }
  header += ",epoch,flags,is_intact,arrival_minus_due_ns,feedback_cycle";
  for (int i = 0; i < model.joint_count; ++i) {
    header.append(",").append(feedback_column(model.joints[i]));
  }
  (void)file->append(header += "\n");
  return WireWriter(std::move(*file), model.joint_count);
}

bool WireWriter::write(const WireRow& seen) noexcept {
  char* const at = file_.begin_row();
  if (at == nullptr) return false;
  const Setpoint& setpoint = seen.setpoint;
  CsvRow row(at);
  row.put_integer(setpoint.cycle).put(',').put_integer(setpoint.due_ns);
  row.put(',').put_integer(setpoint.line);
  for (int i = 0; i < joint_count_; ++i) row.put(',').put_real(setpoint.position[i]);
  for (int i = 0; i < joint_count_; ++i) row.put(',').put_real(setpoint.velocity[i]);
  row.put(',').put_integer(setpoint.epoch).put(',').put_integer(setpoint.flags);
  row.put(',').put_integer(seen.is_intact ? 1 : 0);
  row.put(',').put_integer(seen.arrival_ns - setpoint.due_ns);
  row.put(',').put_integer(seen.feedback_cycle);
  for (int i = 0; i < joint_count_; ++i) row.put(',').put_real(seen.feedback[i]);
  file_.end_row(row.put('\n').end());
  return true;
}

bool WireBook::check_order(const Setpoint& setpoint) {
  const std::uint64_t cycle = setpoint.cycle;
  if (cycle + kRestart < last_cycle_) {
    ++restarts_;
  } else if (cycle <= last_cycle_) {
    ++duplicates_;
    return false;
  } else {
    const auto periods = static_cast<std::int64_t>(cycle - last_cycle_);
    if (setpoint.due_ns - last_due_ != periods * cycle_ns_) ++off_grid_;
  }
  if (cycle > last_cycle_ + 1) {
    const std::uint64_t lost = cycle - last_cycle_ - 1;
    missing_ += lost;
    ++gap_count_;
    longest_gap_ = std::max(longest_gap_, lost);
    if (gaps_.size() < kMaxGaps) gaps_.push_back({last_cycle_, lost});
  }
  return true;
}

/// Following error: feedback against the setpoint that it had seen.
void WireBook::check_following(const WireRow& row) {
  if (row.feedback_cycle == 0 || row.feedback_cycle == last_feedback_cycle_) return;
  last_feedback_cycle_ = row.feedback_cycle;
  ++feedbacks_;
  const auto& [cycle, position] = sent_[row.feedback_cycle % kRemembered];
  if (cycle != row.feedback_cycle) return;
  for (int i = 0; i < model_.joint_count; ++i) {
    worst_following_[i] = std::max(worst_following_[i], std::abs(row.feedback[i] - position[i]));
  }
}

void WireBook::add(const WireRow& row) {
  const Setpoint& setpoint = row.setpoint;
  if (received_ == 0 || check_order(setpoint)) {
    last_cycle_ = setpoint.cycle;
    last_due_ = setpoint.due_ns;
  }
  ++received_;
  const bool is_dry = (setpoint.flags & kSetpointDry) != 0;
  dry_ += is_dry ? 1U : 0U;
  not_intact_ += row.is_intact ? 0U : 1U;
  if (!is_dry) sent_[setpoint.cycle % kRemembered] = {setpoint.cycle, setpoint.position};
  const std::int64_t age = row.arrival_ns - setpoint.due_ns;
  oldest_ns_ = std::max(oldest_ns_, age);
  const double octaves = std::log2(std::max(1.0, static_cast<double>(age) / kFirstEdge_ns));
  ++ages_[std::min(ages_.size() - 1, static_cast<std::size_t>(4 * octaves))];
  check_following(row);
}

std::string WireBook::to_text() const {
  char line[256];
  std::string text;
  const auto add = [&](const char* format, auto... values) {
    std::snprintf(line, sizeof line, format, values...);
    text += line;
  };
  add("setpoints  %llu seen, %llu missing in %llu gaps (longest %llu), %llu doubles or late ones\n",
      static_cast<Count>(received_), static_cast<Count>(missing_), static_cast<Count>(gap_count_),
      static_cast<Count>(longest_gap_), static_cast<Count>(duplicates_));
  for (const Gap& gap : gaps_) {
    add("  %llu missing after cycle %llu\n", static_cast<Count>(gap.count),
        static_cast<Count>(gap.after));
  }
  if (gap_count_ > gaps_.size()) {
    add("  and %llu gaps more\n", static_cast<Count>(gap_count_ - gaps_.size()));
  }
  if (dry_ > 0) add("dry run    %llu of them: no drive followed\n", static_cast<Count>(dry_));
  if (not_intact_ > 0) {
    add("checksum   %llu of another service, or corrupted\n", static_cast<Count>(not_intact_));
  }
  if (off_grid_ > 0) add("  %llu due times off the grid\n", static_cast<Count>(off_grid_));
  if (restarts_ > 0) {
    add("  the service was started anew %llu times\n", static_cast<Count>(restarts_));
  }
  if (received_ > 0) {
    const auto quantile = [&](double share) {
      std::uint64_t below = 0;
      for (std::size_t i = 0; i < ages_.size(); ++i) {
        below += ages_[i];
        if (static_cast<double>(below) >= share * static_cast<double>(received_)) {
          return upper_edge_ns(i) * 1e-3;
        }
      }
      return static_cast<double>(oldest_ns_) * 1e-3;
    };
    add("arrival    behind due: half below %.0f us, 99 %% below %.0f us, the last after %.0f us\n",
        quantile(0.5), quantile(0.99), static_cast<double>(oldest_ns_) * 1e-3);
  }
  add("feedback   %llu seen", static_cast<Count>(feedbacks_));
  for (int i = 0; i < model_.joint_count && feedbacks_ > 0; ++i) {
    const JointSpec& joint = model_.joints[i];
    const double worst =
        joint.is_rotary ? units::deg_from_rad(worst_following_[i]) : worst_following_[i];
    add("%s %s %.6f %s", i == 0 ? "; largest following error:" : ",", joint.name.c_str(), worst,
        joint.is_rotary ? "deg" : "mm");
  }
  return text + "\n";
}

}  // namespace meridian::record
