// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/picture/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "meridian/units.hpp"
#include "service/analysis/plot/gnuplot.hpp"
#include "service/recording/record/picture/joint_colours.hpp"
#include "service/recording/record/picture/picture_data.hpp"

namespace meridian::record {
namespace {

constexpr std::size_t kColumns = 1500;
constexpr int kWhiskers = 160;  ///< lines along the tool axis, over the whole cut
constexpr const char* kRateLabels[] = {"velocity", "accel.", "jerk"};

using plot::quoted;

[[nodiscard]] double at_edge(const JointSpec& joint, double value) {
  return joint.is_rotary ? units::deg_from_rad(value) : value;
}

void print(std::FILE* out, const Extremes& value, double scale) {
  if (value.is_empty) {
    std::fputs(" NaN NaN", out);
  } else {
    std::fprintf(out, " %.7g %.7g", value.low * scale, value.high * scale);
  }
}

[[nodiscard]] double largest(const Extremes& rate) {
  return std::max(std::abs(rate.low), std::abs(rate.high));
}

/// Ranges of the program's tip path, approach and rewinds left out.
[[nodiscard]] std::array<Extremes, 3> box_of(const PictureData& data) {
  std::array<Extremes, 3> box;
  for (const PictureData::Point& point : data.tip) {
    if (point.kind == MotionKind::kApproach || point.kind == MotionKind::kRewind) continue;
    for (int i = 0; i < 3; ++i) box[static_cast<std::size_t>(i)].add(point.tip[i]);
  }
  return box;
}

[[nodiscard]] double longest_side(const std::array<Extremes, 3>& box) {
  double longest = 1;
  for (const Extremes& side : box) longest = std::max(longest, side.high - side.low);
  return longest;
}

/// Data block $whiskers: the tool axis at even steps along the cut, as vectors.
void print_whiskers(std::FILE* out, const PictureData& data) {
  double total = 0;
  const auto each_cut = [&data](auto&& use) {
    for (std::size_t i = 1; i < data.tip.size(); ++i) {
      const auto& from = data.tip[i - 1];
      const auto& to = data.tip[i];
      if (from.kind != MotionKind::kCut || to.kind != MotionKind::kCut) continue;
      use(to, (to.tip - from.tip).norm());
    }
  };
  each_cut([&total](const PictureData::Point&, double step) { total += step; });
  const double length = 0.16 * longest_side(box_of(data));
  double since = total;
  std::fputs("$whiskers << EOD\n", out);
  each_cut([&](const PictureData::Point& at, double step) {
    since += step;
    if (since < total / kWhiskers) return;
    since = 0;
    const Vector3 by = length * at.axis;
    std::fprintf(out, "%.6g %.6g %.6g %.6g %.6g %.6g\n", at.tip[0], at.tip[1], at.tip[2], by[0],
                 by[1], by[2]);
  });
  std::fputs(total > 0 ? "EOD\n" : "NaN NaN NaN NaN NaN NaN\nEOD\n", out);
}

/// Data blocks: $way (a blank line parts stretches of one kind) and $columns.
void print_data(std::FILE* out, const PictureData& data, const MachineModel& model) {
  for (int kind = 0; kind < 4; ++kind) {
    std::fprintf(out, "$way%d << EOD\n", kind);
    bool is_open = false, has_any = false;
    for (const PictureData::Point& point : data.tip) {
      if (static_cast<int>(point.kind) == kind) {
        std::fprintf(out, "%.6g %.6g %.6g\n", point.tip[0], point.tip[1], point.tip[2]);
        is_open = has_any = true;
      } else if (is_open) {
        std::fputs("\n", out);
        is_open = false;
      }
    }
    std::fputs(has_any ? "EOD\n" : "NaN NaN NaN\nEOD\n", out);
  }
  print_whiskers(out, data);
  std::fputs("$columns << EOD\n", out);
  for (const PictureColumn& column : data.columns) {
    std::fprintf(out, "%.7g", column.time_s);
    print(out, column.tip_speed_mm_per_s, units::kMinute_s);
    print(out, column.feed_mm_per_s, units::kMinute_s);
    for (int i = 0; i < model.joint_count; ++i) {
      print(out, column.position[i], at_edge(model.joints[i], 1.0));
      for (int order = 0; order < 3; ++order) {
        const Extremes& rate = column.rate[order][i];
        std::fprintf(out, " %.5g", largest(rate));
      }
    }
    for (int order = 0; order < 3; ++order) {
      double max = 0;
      for (const Extremes& rate : column.rate[order]) max = std::max(max, largest(rate));
      std::fprintf(out, " %.5g", max);
    }
    std::fputs("\n", out);
  }
  std::fputs("EOD\n", out);
}

/// Column of a joint's lowest position; the highest and the shares of its three limits follow.
[[nodiscard]] constexpr int column_of(int joint) { return 6 + 5 * joint; }

[[nodiscard]] bool has_joint(const MachineModel& model, bool is_rotary) {
  return std::any_of(model.joints.begin(), model.joints.begin() + model.joint_count,
                     [&](const JointSpec& joint) { return joint.is_rotary == is_rotary; });
}

/// One panel of the linear joints or of the rotary ones, of which there is one at least.
void print_joints(std::FILE* out, const MachineModel& model, bool is_rotary) {
  std::fprintf(out, "set ylabel 'joints, %s'\n", is_rotary ? "deg" : "mm");
  const char* separator = "plot";
  for (int i = 0; i < model.joint_count; ++i) {
    if (model.joints[i].is_rotary != is_rotary) continue;
    const int low = column_of(i);
    std::fprintf(out,
                 "%s $columns using 1:%d:%d with filledcurves fs transparent solid 0.5 lc '%s' "
                 "notitle, $columns using 1:%d with lines lw 1.5 lc '%s' title %s",
                 separator, low, low + 1, kJointColours[i], low + 1, kJointColours[i],
                 quoted(model.joints[i].name).c_str());
    separator = ",";
  }
  std::fputs("\n", out);
}

void print_velocities(std::FILE* out, const MachineModel& model) {
  std::fputs("set ylabel 'velocity, %'\nset yrange [0:115]\nset ytics 50\n", out);
  std::fputs("plot 100 lw 2 lc '#cc3333' title 'limit, 100 %'", out);
  for (int i = 0; i < model.joint_count; ++i) {
    std::fprintf(out, ", $columns using 1:(100*$%d) with lines lw 1.5 lc '%s' title %s",
                 column_of(i) + 2, kJointColours[i], quoted(model.joints[i].name).c_str());
  }
  std::fputs("\n", out);
}

/// Of all joints the largest share of acceleration or jerk.
void print_largest(std::FILE* out, const MachineModel& model, int order) {
  const int column = column_of(model.joint_count) + order;
  std::fprintf(out, "set ylabel '%s, %%'\n", kRateLabels[order]);
  std::fprintf(out,
               "plot 100 lw 2 lc '#cc3333' title 'limit, 100 %%', $columns using 1:(100*$%d) with "
               "filledcurves y1=0 fs transparent solid 0.35 lc '#1f5fa8' notitle, $columns using "
               "1:(100*$%d) with lines lw 1 lc '#1f5fa8' title 'largest joint'\n",
               column, column);
}

void print_feed(std::FILE* out, const PictureData& data) {
  double feed = 0;
  for (const PictureColumn& column : data.columns) feed = std::max(feed, column.feed_mm_per_s.high);
  std::fputs("set ylabel 'tip, mm/min'\n", out);
  if (feed > 0) {
    std::fprintf(out, "set yrange [0:%.6g]\n", 1.3 * feed * units::kMinute_s);
  } else {
    std::fputs("set yrange [0:*]\n", out);
  }
  std::fputs(
      "plot $columns using 1:2:3 with filledcurves fs transparent solid 0.4 lc '#1f5fa8' notitle, "
      "$columns using 1:3 with lines lw 1.5 lc '#1f5fa8' title 'achieved', ",
      out);
  std::fputs(feed > 0 ? "$columns using 1:5 with lines lw 2 lc '#cc3333' title 'programmed'\n"
                      : "-1 lw 2 lc '#cc3333' title 'feed unknown'\n",
             out);
  std::fputs("set yrange [*:*]\n", out);
}

/// Ranges of the space that the tip path and the tool axes on it take.
void print_ranges(std::FILE* out, const PictureData& data) {
  const std::array<Extremes, 3> box = box_of(data);
  if (box[0].is_empty) return;
  const double longest = longest_side(box);
  for (std::size_t i = 0; i < 3; ++i) {
    std::fprintf(out, "set %crange [%.6g:%.6g]\n", "xyz"[i], box[i].low - 0.05 * longest,
                 box[i].high + (i == 2 ? 0.2 : 0.05) * longest);
  }
}

void print_space(std::FILE* out, const PictureData& data) {
  print_ranges(out, data);
  std::fputs(
      "set grid lc '#dddddd'\nset border lc '#555555'\n"
      "set origin 0.015,0\nset size 0.52,0.95\nset view equal xyz\nset view 58,33,1.28\n"
      "set ticslevel 0\nset xyplane relative 0\n"
      "set xlabel 'x, mm'\nset ylabel 'y, mm'\nset zlabel 'z' offset 2,0\n"
      "set key at screen 0.03,0.93 left top reverse Left samplen 2\n"
      "splot $whiskers with vectors nohead lw 1 lc '#9db8d8' title 'tool axis', "
      "$way0 with lines lw 2 lc '#bbbbbb' title 'approach', "
      "$way2 with lines lw 2 lc '#e08214' title 'rapid', "
      "$way1 with lines lw 3 lc '#1f5fa8' title 'cut', "
      "$way3 with points pt 7 ps 1.5 lc '#c22f4f' title 'turn at the pole'\n",
      out);
}

void print_script(std::FILE* out, const PictureData& data, const MachineModel& model,
                  const std::string& title) {
  print_data(out, data, model);
  std::fprintf(out, "set multiplot title %s font ',20'\n", quoted(title).c_str());
  print_space(out, data);
  std::fputs(
      "unset view\nset key outside right top noreverse Right samplen 1.5\nunset zlabel\n"
      "set xlabel\nset ytics font ',12'\nset autoscale\nset lmargin 10\nset rmargin 17\nset "
      "bmargin 0.8\n"
      "set tmargin 0.8\nset format x ''\n",
      out);
  std::fprintf(out, "set xrange [0:%.7g]\n", data.columns.back().time_s);
  const int panels = 4 + has_joint(model, false) + has_joint(model, true);
  const double height = 0.9 / panels;
  int panel = 0;
  const auto next = [&] {
    std::fprintf(out, "set origin 0.5,%.4f\nset size 0.5,%.4f\n", 0.95 - height * ++panel, height);
  };
  next();
  print_feed(out, data);
  for (const bool is_rotary : {false, true}) {
    if (!has_joint(model, is_rotary)) continue;
    next();
    print_joints(out, model, is_rotary);
  }
  next();
  print_velocities(out, model);
  next();
  print_largest(out, model, 1);
  next();
  // The last one carries the axis.
  std::fputs("set xlabel 'time, s' offset 0,0.6\nset format x '%g'\nset bmargin at screen 0.065\n",
             out);
  print_largest(out, model, 2);
}

}  // namespace

std::optional<RecordError> draw(RecordingReader& recording, const CheckedPath& path,
                                const MachineModel& model, const std::string& title,
                                const std::string& file) {
  PictureData data;
  if (auto error = gather(recording, path, model, kColumns, data)) return error;
  char details[160];
  std::snprintf(details, sizeof details, "machine %s, %.1f s", model.name.c_str(),
                data.columns.back().time_s);
  const std::string whole = title.empty() ? details : title + ", " + details;
  const auto error = plot::draw(file, {1800, 1260, 18, 15},
                                [&](std::FILE* out) { print_script(out, data, model, whole); });
  if (!error) return std::nullopt;
  return RecordError{error->file, 0, error->message, error->remedy};
}

}  // namespace meridian::record
