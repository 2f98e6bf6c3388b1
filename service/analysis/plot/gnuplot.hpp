// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

/// Pictures by gnuplot, a program of Debian's that is started for each. Blocks until it is done.
namespace meridian::plot {

/// Why there is no picture, and what to do about it.
struct PlotError {
  std::string file, message, remedy;
  /// "file: message; remedy".
  [[nodiscard]] std::string text() const { return file + ": " + message + "; " + remedy; }
};

/// Size in pixels, and of the letters in points, which .svg and .png measure differently.
struct Sheet {
  int width = 1200, height = 1000;
  int svg_font = 14, png_font = 10;
};

/// gnuplot's single-quoted string.
[[nodiscard]] std::string quoted(std::string_view text);

/// Draws `file`, .png or .svg by its name, with what `print` writes: gnuplot commands for one
/// multiplot, data blocks included. Proof: tests/unit/record/picture_test.cpp.
[[nodiscard]] std::optional<PlotError> draw(const std::string& file, const Sheet& sheet,
                                            const std::function<void(std::FILE*)>& print);

}  // namespace meridian::plot
