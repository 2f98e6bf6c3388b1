// SPDX-License-Identifier: Apache-2.0
#include "service/cl/run_cl.hpp"

#include <array>
#include <charconv>
#include <fstream>
#include <iostream>

#include "meridian/units.hpp"
#include "service/cl/cl_reader.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::cl {
namespace {

constexpr int kFine = 0;
constexpr int kInputRefused = 3;
constexpr std::size_t kFlushAt = 256 * 1024;

void append(std::string& text, double value, char behind) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value + 0.0).ptr;
  text.append(digits.data(), end);
  text.push_back(behind);
}

void append(std::string& text, const ClPoint& point) {
  for (const double x : point.tip) append(text, x, ' ');
  for (const double k : point.axis) append(text, k, ' ');
  append(text, units::per_min_from_per_s(point.feed_mm_per_s), '\n');
}

int read_through(const RunOptions& options, std::istream& in, std::ostream& out,
                 std::ostream& err) {
  ClReader reader(in, options.file == "-" ? "<standard input>" : options.file, options.reader);
  PointWalker walker(options.chord_error_mm);
  std::string text;
  std::size_t warned = 0;
  const auto warn = [&] {
    for (; warned < reader.warnings().size(); ++warned) {
      const ClWarning& warning = reader.warnings()[warned];
      err << options.file << ":" << warning.line << ": warning: " << warning.message << "\n";
    }
  };
  while (true) {
    const auto block = reader.next();
    if (!block) {
      warn();
      err << block.error().text() << "\n";
      return kInputRefused;
    }
    if (!*block) break;
    if (options.summary) continue;
    walker.walk(**block, [&](const ClPoint& point) {
      append(text, point);
      if (text.size() > kFlushAt) {
        out << text;
        text.clear();
      }
    });
  }
  warn();
  out << (options.summary ? to_text(reader.summary()) : text) << std::flush;
  if (!out) {
    err << "meridian cl: the output cannot be written\n";
    return kInputRefused;
  }
  return kFine;
}

}  // namespace

int run_cl(const RunOptions& options, std::ostream& out, std::ostream& err) {
  std::ifstream file;
  if (options.file != "-") {
    file.open(options.file, std::ios::binary);
    if (!file) {
      err << options.file << ": cannot be opened\n";
      return kInputRefused;
    }
  }
  if (options.file == "-") std::ios::sync_with_stdio(false);
  std::istream& in = options.file == "-" ? std::cin : file;
  if (options.output.empty()) return read_through(options, in, out, err);
  if (const auto lost = text::refusal_to_write({options.file}, {options.output}); !lost.empty()) {
    err << lost << "\n";
    return kInputRefused;
  }
  text::WholeFile target(options.output);
  const int code = read_through(options, in, target.out(), err);
  if (code != kFine || target.commit()) return code;
  err << options.output << ": cannot be written\n";
  return kInputRefused;
}

}  // namespace meridian::cl
