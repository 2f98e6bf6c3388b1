// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/interpreter/run_cl.hpp"

#include <array>
#include <charconv>
#include <fstream>
#include <iostream>

#include "meridian/units.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/programs/cl/findings.hpp"
#include "service/text/printed.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::cl {
namespace {

constexpr int kFine = 0;
constexpr int kInputRefused = 3;
constexpr std::size_t kFlushAt = 256 * 1024;

void append(std::string& text, double value, char rest) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value + 0.0).ptr;
  text.append(digits.data(), end);
  text.push_back(rest);
}

void append(std::string& text, const ClPoint& point) {
  for (const double x : point.tip) append(text, x, ' ');
  for (const double k : point.axis) append(text, k, ' ');
  append(text, units::per_min_from_per_s(point.feed_mm_per_s), '\n');
}

/// The points as they are read, so that a pipe sees them at once.
class PointOutput {
 public:
  PointOutput(std::ostream& out, double chord_error_mm) : out_(out), walker_(chord_error_mm) {}

  void add(const ClBlock& block) {
    walker_.walk(block, [this](const ClPoint& point) {
      append(text_, point);
      if (text_.size() > kFlushAt) flush();
    });
  }
  void flush() {
    out_ << text_;
    text_.clear();
  }

 private:
  std::ostream& out_;
  PointWalker walker_;
  std::string text_;
};

int read_through(const RunOptions& options, std::istream& in, std::ostream& out,
                 std::ostream& err) {
  const std::string name = options.file == "-" ? "<standard input>" : options.file;
  ClReader reader(in, name, options.reader);
  PointOutput points(out, options.chord_error_mm);
  Findings findings;
  while (true) {
    const auto block = reader.next();
    if (!block) {
      findings.add(block.error());
      if (!reader.go_on()) break;
      continue;
    }
    if (!*block) break;
    const bool is_wanted = options.what == RunOptions::Output::kPoints && !findings.is_refused();
    if (is_wanted) points.add(**block);
  }
  const bool is_refused = findings.is_refused();
  for (const ClWarning& warning : reader.warnings()) findings.add(warning);
  if (options.what == RunOptions::Output::kJson) {
    out << "{\"file\": " << text::json_quoted(name)
        << ", \"is_refused\": " << (is_refused ? "true" : "false")
        << ",\n\"summary\": " << to_json(reader.summary())
        << ",\n\"findings\": " << to_json(findings.sorted()) << "}\n";
  } else {
    err << to_text(findings.sorted(), name);
    if (!is_refused && options.what == RunOptions::Output::kSummary) {
      out << to_text(reader.summary());
    }
    if (!is_refused) points.flush();
  }
  out.flush();
  if (!out) {
    err << "meridian cl: the output cannot be written\n";
    return kInputRefused;
  }
  return is_refused ? kInputRefused : kFine;
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
