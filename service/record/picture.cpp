// SPDX-License-Identifier: Apache-2.0
#include "service/record/picture.hpp"

#include <sys/wait.h>

#include <cstdio>
#include <string_view>

#include "meridian/units.hpp"
#include "service/record/picture_data.hpp"

namespace meridian::record {
namespace {

constexpr std::size_t kColumns = 1500;
constexpr const char* kRateNames[] = {"velocity", "acceleration", "jerk"};

/// gnuplot's single-quoted string.
[[nodiscard]] std::string quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

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
  std::fputs("$columns << EOD\n", out);
  for (const PictureColumn& column : data.columns) {
    std::fprintf(out, "%.7g", column.time_s);
    print(out, column.tip_speed_mm_per_s, units::kMinute_s);
    print(out, column.feed_mm_per_s, units::kMinute_s);
    for (int i = 0; i < model.joint_count; ++i) {
      print(out, column.position[i], at_edge(model.joints[i], 1.0));
      for (int order = 0; order < 3; ++order) print(out, column.rate[order][i], 1);
    }
    std::fputs("\n", out);
  }
  std::fputs("EOD\n", out);
}

/// A band from the low to the high column of one value, with a line on top where it is thin.
void print_band(std::FILE* out, int low, const std::string& title, int colour, bool is_first) {
  std::fprintf(
      out,
      "%s $columns using 1:%d:%d with filledcurves fs transparent solid 0.6 lc %d notitle, "
      "$columns using 1:%d with lines lw 1 lc %d title %s",
      is_first ? "plot" : ",", low, low + 1, colour, low + 1, colour, quoted(title).c_str());
}

[[nodiscard]] constexpr int column_of(int joint, int what) { return 6 + 8 * joint + 2 * what; }

void print_joints(std::FILE* out, const MachineModel& model, bool is_rotary) {
  std::fprintf(out, "set ylabel 'joints, %s'\n", is_rotary ? "deg" : "mm");
  bool is_first = true;
  for (int i = 0; i < model.joint_count; ++i) {
    if (model.joints[i].is_rotary != is_rotary) continue;
    print_band(out, column_of(i, 0), model.joints[i].name, i + 1, is_first);
    is_first = false;
  }
  std::fputs(is_first ? "plot NaN notitle\n" : "\n", out);
}

void print_script(std::FILE* out, const PictureData& data, const MachineModel& model,
                  const std::string& title, const std::string& file, bool is_svg) {
  print_data(out, data, model);
  std::fprintf(out,
               "set terminal %s size 1500,1200 background '#ffffff' font 'sans,%d' noenhanced\n",
               is_svg ? "svg" : "pngcairo", is_svg ? 14 : 11);
  std::fprintf(out, "set output %s\n", quoted(file).c_str());
  std::fprintf(out, "set multiplot title %s\n", quoted(title).c_str());
  std::fputs(
      "set key outside right top samplen 1\nset grid lc '#dddddd'\nset border lc '#555555'\n"
      "set origin 0,0.02\nset size 0.48,0.93\nset view equal xyz\nset view 60,35\nset ticslevel 0\n"
      "set xlabel 'x, mm'\nset ylabel 'y, mm'\nset zlabel 'z, mm'\nset key inside right top\n"
      "set xtics autofreq\n"
      "splot $way0 with lines lc '#bbbbbb' title 'approach', $way2 with lines lc '#cc6633' title "
      "'rapid', $way1 with lines lc '#1f5fa8' title 'cut', $way3 with points pt 7 ps 0.5 lc "
      "'#aa2288' title 'pole turn'\n"
      "unset view\nset key outside right top samplen 1\nset xlabel\nset lmargin 10\n"
      "set rmargin 14\nset bmargin 1.6\nset tmargin 0.6\nunset zlabel\n",
      out);
  std::fprintf(out, "set xrange [0:%.7g]\n", data.columns.back().time_s);
  constexpr double kHeight = 0.93 / 6;
  int place = 0;
  const auto next = [&] {
    std::fprintf(out, "set origin 0.48,%.4f\nset size 0.52,%.4f\n", 0.95 - kHeight * ++place,
                 kHeight);
  };
  next();
  print_joints(out, model, false);
  next();
  print_joints(out, model, true);
  next();
  std::fputs(
      "set ylabel 'tip, mm/min'\nset yrange [0:*]\n"
      "plot $columns using 1:5 with lines lw 1.5 lc '#cc3333' title 'programmed', $columns using "
      "1:2:3 with filledcurves fs transparent solid 0.6 lc '#1f5fa8' notitle, $columns using 1:3 "
      "with lines lc '#1f5fa8' title 'achieved'\n",
      out);
  for (int order = 0; order < 3; ++order) {
    next();
    if (order == 2) std::fputs("set xlabel 'time, s' offset 0,0.6\nset bmargin 2.6\n", out);
    std::fprintf(out, "set ylabel '%s / limit'\nset yrange [-1.1:1.1]\n", kRateNames[order]);
    for (int i = 0; i < model.joint_count; ++i) {
      print_band(out, column_of(i, 1 + order), model.joints[i].name, i + 1, i == 0);
    }
    std::fputs(", 1 lc '#cc3333' notitle, -1 lc '#cc3333' notitle\n", out);
  }
  std::fputs("unset multiplot\nset output\n", out);
}

}  // namespace

std::optional<RecordError> draw(RecordingReader& recording, const CheckedPath& path,
                                const MachineModel& model, const std::string& file) {
  const bool is_svg = file.ends_with(".svg");
  if (!is_svg && !file.ends_with(".png")) {
    return RecordError{file, 0, "no picture format that is known", "end the name in .png or .svg"};
  }
  PictureData data;
  if (auto error = gather(recording, path, model, kColumns, data)) return error;
  std::FILE* gnuplot = ::popen("gnuplot", "w");
  if (gnuplot == nullptr) {
    return RecordError{file, 0, "gnuplot cannot be started", "install gnuplot-nox"};
  }
  char title[160];
  std::snprintf(title, sizeof title, "machine %s, %.1f s, limits at 1", model.name.c_str(),
                data.columns.back().time_s);
  print_script(gnuplot, data, model, title, file, is_svg);
  const int status = ::pclose(gnuplot);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return std::nullopt;
  return RecordError{file, 0, "gnuplot failed", "install gnuplot-nox; is the folder writable?"};
}

}  // namespace meridian::record
