// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/cl_writer.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "meridian/units.hpp"

namespace meridian::cl {
namespace {

constexpr int kTipDecimals = 6;
constexpr int kAxisDecimals = 9;
constexpr std::size_t kLineLength = 72;  // what card images held, and every reader takes

/// Fixed decimals; never "-0.000".
void add(std::string& text, double value, int decimals) {
  if (!text.empty()) text += ",";
  std::array<char, 64> digits{};
  const double min = 0.5 * std::pow(10.0, -decimals);
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(),
                    std::abs(value) < min ? 0.0 : value, std::chars_format::fixed, decimals)
          .ptr;
  text.append(digits.data(), end);
}

void add(std::string& text, const Array3& v, int decimals) {
  for (const double x : v) add(text, x, decimals);
}

/// As few digits as read back to the same number.
std::string shortest(double value) {
  std::array<char, 32> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed)
          .ptr;
  return {digits.data(), end};
}

/// Twelve digits of a feed: 1000 mm/min comes back from mm/s as 1000, not as 1000.0000000000001.
std::string feed_text(double feed) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), feed,
                                 std::chars_format::general, 12)
                       .ptr;
  return {digits.data(), end};
}

}  // namespace

ClWriter::ClWriter(std::ostream& out, std::string_view part) : out_(out) {
  out_ << "PARTNO " << part << "\nUNITS/MM\nMULTAX/ON\n";
}

void ClWriter::note(std::string_view text) { out_ << "$$ " << text << "\n"; }

void ClWriter::statement(std::string_view word, const std::string& arguments) {
  std::string line = std::string(word) + "/" + arguments;
  while (line.size() > kLineLength) {
    const std::size_t comma = line.rfind(',', kLineLength - 2);
    if (comma == std::string::npos) break;
    out_ << line.substr(0, comma + 1) << "$\n";
    line = "  " + line.substr(comma + 1);
  }
  out_ << line << "\n";
}

void ClWriter::write_motion(const ClBlock& b) {
  if (b.kind == BlockKind::kRapid) {
    out_ << "RAPID\n";
  } else if (b.feed_meaning != feed_meaning_ || b.feed != feed_) {
    const std::string feed = feed_text(units::per_min_from_per_s(b.feed));
    statement("FEDRAT",
              b.feed_meaning == FeedMeaning::kInverseTime ? "INVERS," + feed : feed + ",MMPM");
    feed_meaning_ = b.feed_meaning;
    feed_ = b.feed;
  }
  if (b.is_arc) {
    std::string circle;
    add(circle, b.centre_mm, kAxisDecimals);
    add(circle, b.normal, kAxisDecimals);
    statement("CIRCLE", circle);
  }
  std::string point;
  add(point, b.tip_mm, kTipDecimals);
  // What a missing axis means after a tilted one differs from system to system.
  const bool is_tilted = b.axis != Array3{0, 0, 1};
  if (!has_axis_ || is_tilted || b.axis != axis_) add(point, b.axis, kAxisDecimals);
  axis_ = b.axis;
  has_axis_ = true;
  statement("GOTO", point);
}

void ClWriter::write_auxiliary(const ClBlock& b) {
  switch (b.action) {
    case ActionKind::kSpindleOff:
      return statement("SPINDL", "OFF");
    case ActionKind::kSpindleClockwise:
      return statement("SPINDL", shortest(b.value) + ",RPM,CLW");
    case ActionKind::kSpindleCounterClockwise:
      return statement("SPINDL", shortest(b.value) + ",RPM,CCLW");
    case ActionKind::kCoolantOff:
      return statement("COOLNT", "OFF");
    case ActionKind::kCoolantFlood:
      return statement("COOLNT", "FLOOD");
    case ActionKind::kCoolantMist:
      return statement("COOLNT", "MIST");
    case ActionKind::kCoolantThrough:
      return statement("COOLNT", "THRU");
    case ActionKind::kVendorWord:
      out_ << b.text << "\n";
      return;
    case ActionKind::kNone:
    case ActionKind::kToolChange:
    case ActionKind::kStop:
      return;
  }
}

void ClWriter::write(const ClBlock& b) {
  switch (b.kind) {
    case BlockKind::kCut:
    case BlockKind::kRapid:
      return write_motion(b);
    case BlockKind::kDwell:
      return statement("DELAY", shortest(b.value));
    case BlockKind::kAuxiliary:
      return write_auxiliary(b);
    case BlockKind::kTool:
      return statement("LOADTL", shortest(b.value));
    case BlockKind::kStop:
      out_ << "STOP\n";
      return;
    case BlockKind::kOptionalStop:
      out_ << "OPSTOP\n";
      return;
    case BlockKind::kEnd:
      out_ << "FINI\n";
      return;
  }
}

}  // namespace meridian::cl
