// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/plot/gnuplot.hpp"

#include <sys/wait.h>

namespace meridian::plot {

std::string quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

std::optional<PlotError> draw(const std::string& file, const Sheet& sheet,
                              const std::function<void(std::FILE*)>& print) {
  const bool is_svg = file.ends_with(".svg");
  if (!is_svg && !file.ends_with(".png")) {
    return PlotError{file, "no picture format that is known", "end the name in .png or .svg"};
  }
  std::FILE* gnuplot = ::popen("gnuplot", "w");
  if (gnuplot == nullptr) {
    return PlotError{file, "gnuplot cannot be started", "install gnuplot-nox"};
  }
  std::fprintf(gnuplot,
               "set terminal %s size %d,%d background '#ffffff' font 'sans,%d' noenhanced\n"
               "set output %s\n",
               is_svg ? "svg" : "pngcairo", sheet.width, sheet.height,
               is_svg ? sheet.svg_font : sheet.png_font, quoted(file).c_str());
  print(gnuplot);
  std::fputs("unset multiplot\nset output\n", gnuplot);
  const int status = ::pclose(gnuplot);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return std::nullopt;
  return PlotError{file, "gnuplot failed", "install gnuplot-nox; is the folder writable?"};
}

}  // namespace meridian::plot
