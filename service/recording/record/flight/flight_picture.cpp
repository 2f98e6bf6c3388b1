// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/flight/flight_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/analysis/plot/gnuplot.hpp"
#include "service/recording/record/file/recorded/sent_positions.hpp"
#include "service/recording/record/picture/joint_colours.hpp"
#include "service/recording/record/words.hpp"

namespace meridian::record {
namespace {

constexpr std::size_t kMaxMoments = 1500;  ///< of a strip: as many as it has pixels, and more
constexpr double kNearBefore_s = 0.2, kNearAfter_s = 0.4;

/// Some neighbouring cycles: the last positions, the largest of the rest.
struct Moment {
  bool is_empty = true;
  double time_s = 0, sent = 0, reported = 0;
  std::array<double, kMaxJoints> following{}, velocity{};  ///< shares of what is allowed
};

/// A stretch of time from the alarm, in moments of equal length.
class Strip {
 public:
  Strip(double begin_s, double end_s, double cycle_s) : begin_s_(begin_s), end_s_(end_s) {
    const double cycles = std::max(1.0, (end_s - begin_s) / cycle_s);
    moments.resize(static_cast<std::size_t>(std::min<double>(cycles, kMaxMoments)) + 1);
  }

  void add(const Moment& cycle) {
    if (cycle.time_s < begin_s_ || cycle.time_s > end_s_) return;
    const double share = (cycle.time_s - begin_s_) / std::max(1e-9, end_s_ - begin_s_);
    Moment& moment = moments[std::min(
        moments.size() - 1, static_cast<std::size_t>(share * static_cast<double>(moments.size())))];
    Moment joined = cycle;
    for (std::size_t i = 0; i < kMaxJoints && !moment.is_empty; ++i) {
      joined.following[i] = std::max(joined.following[i], moment.following[i]);
      joined.velocity[i] = std::max(joined.velocity[i], moment.velocity[i]);
    }
    moment = joined;
  }

  std::vector<Moment> moments;

 private:
  double begin_s_, end_s_;
};

[[nodiscard]] double share(double value, double allowed) {
  return allowed > 0 ? std::abs(value) / allowed : 0;
}

/// The drive that is shown by itself.
[[nodiscard]] int find_drive(const FlightReport& report, const MachineModel& model) {
  if (report.joint >= model.joint_count) {
    return report.joint == model.joint_count ? model.stage.linear_joint : model.stage.rotary_joint;
  }
  if (report.joint >= 0) return report.joint;
  int worst = 0;
  double max = -1;
  for (int i = 0; i < model.joint_count; ++i) {
    const Following& following = report.following[static_cast<std::size_t>(i)];
    const double is = share(std::max(std::abs(following.before), std::abs(following.after)),
                            drive_spec(model, i).limits.following_error);
    if (is > max) worst = i;
    max = std::max(max, is);
  }
  return worst;
}

[[nodiscard]] Moment moment_of(const RecordingRow& row, const SentPositions& sent,
                               const MachineModel& model, int drive, double time_s) {
  Moment moment;
  moment.is_empty = false;
  moment.time_s = time_s;
  const double scale = drive_spec(model, drive).is_rotary ? units::deg_from_rad(1.0) : 1.0;
  moment.sent = scale * sent_position(row, model, drive);
  moment.reported = scale * row.feedback[static_cast<std::size_t>(drive)];
  const bool is_enabled = (row.flags & kSetpointEnabled) != 0;
  const JointVector* const seen = is_enabled ? sent.seen_by(row) : nullptr;
  for (int i = 0; i < model.joint_count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const JointLimits& limits = drive_spec(model, i).limits;
    if (seen != nullptr) {
      moment.following[n] = share(row.feedback[n] - (*seen)[n], limits.following_error);
    }
    if (is_enabled) moment.velocity[n] = share(row.velocity[n], model.joints[n].limits.velocity);
  }
  return moment;
}

void print_block(std::FILE* out, const char* name, const Strip& strip, int drives) {
  std::fprintf(out, "$%s << EOD\n", name);
  for (const Moment& moment : strip.moments) {
    if (moment.is_empty) continue;
    std::fprintf(out, "%.7g %.9g %.9g", moment.time_s, moment.sent, moment.reported);
    for (std::size_t i = 0; i < static_cast<std::size_t>(drives); ++i) {
      std::fprintf(out, " %.6g %.6g", 100 * moment.following[i], 100 * moment.velocity[i]);
    }
    std::fputs("\n", out);
  }
  std::fputs("EOD\n", out);
}

/// Columns of drive `i` in a block.
[[nodiscard]] constexpr int following_column(int i) { return 4 + 2 * i; }
[[nodiscard]] constexpr int velocity_column_of(int i) { return 5 + 2 * i; }

void print_shares(std::FILE* out, const char* block, const MachineModel& model, const char* label,
                  int (*column)(int)) {
  std::fprintf(
      out, "set ylabel '%s'\nset yrange [0:*]\nplot 100 lw 1.5 dt 3 lc '#000000' title '100 %%'",
      label);
  for (int i = 0; i < model.joint_count; ++i) {
    std::fprintf(out, ", $%s using 1:%d with lines lw 1.5 lc '%s' title %s", block, column(i),
                 kJointColours[i], plot::quoted(drive_spec(model, i).name).c_str());
  }
  std::fputs("\nset yrange [*:*]\n", out);
}

void print_side(std::FILE* out, const char* block, double left, const MachineModel& model,
                int drive) {
  const JointSpec& spec = drive_spec(model, drive);
  int rank = 0;
  const auto next = [&] {
    std::fprintf(out, "set origin %.3f,%.3f\nset size 0.5,0.31\n", left, 0.94 - 0.31 * ++rank);
  };
  std::fputs("set xlabel\n", out);
  next();
  std::fprintf(out,
               "set ylabel '%s, %s'\nplot $%s using 1:2 with lines lw 2 lc '#1f5fa8' title 'sent', "
               "$%s using 1:3 with lines lw 2 lc '#e08214' title 'reported'\n",
               spec.name.c_str(), spec.is_rotary ? "deg" : "mm", block, block);
  next();
  print_shares(out, block, model, "following error, % of allowed", following_column);
  next();
  std::fputs("set xlabel 'time from the alarm, s'\n", out);
  print_shares(out, block, model, "velocity sent, % of limit", velocity_column_of);
}

}  // namespace

std::optional<RecordError> draw_flight(RecordingReader& recording, const FlightReport& report,
                                       const MachineModel& model, const std::string& file) {
  const int drive = find_drive(report, model);
  const double cycle_s = static_cast<double>(model.cycle_ns) * 1e-9;
  Strip whole(-report.before_s, report.after_s, cycle_s);
  Strip near(std::max(-report.before_s, -kNearBefore_s), std::min(report.after_s, kNearAfter_s),
             cycle_s);
  const auto sent = std::make_unique<SentPositions>();
  recording.rewind();
  RecordingRow row;
  std::int64_t first_ns = 0;
  for (bool is_first = true;; is_first = false) {
    const auto read = recording.next(row);
    if (!read) return read.error();
    if (!*read) break;
    if (is_first) first_ns = row.due_ns;
    const double time_s = 1e-9 * static_cast<double>(row.due_ns - first_ns) - report.before_s;
    sent->note(row, model);
    const Moment moment = moment_of(row, *sent, model, drive, time_s);
    whole.add(moment);
    near.add(moment);
  }
  const std::string title = "machine " + model.name + ", alarm: " + std::string(word(report.alarm));
  const auto error = plot::draw(file, {1600, 1000, 16, 13}, [&](std::FILE* out) {
    print_block(out, "whole", whole, model.joint_count);
    print_block(out, "near", near, model.joint_count);
    std::fprintf(out, "set multiplot title %s font ',20'\n", plot::quoted(title).c_str());
    std::fputs(
        "set grid lc '#dddddd'\nset border lc '#555555'\nset key outside top center "
        "horizontal samplen 1.5\nset arrow from 0, graph 0 to 0, graph 1 nohead lw 1.5 dt 2 "
        "lc '#cc3333'\nset lmargin 11\nset rmargin 3\n",
        out);
    print_side(out, "whole", 0, model, drive);
    print_side(out, "near", 0.5, model, drive);
  });
  if (!error) return std::nullopt;
  return RecordError{error->file, 0, error->message, error->remedy};
}

}  // namespace meridian::record
