// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <cmath>

#include "meridian/units.hpp"
#include "service/programs/cl/words/handlers.hpp"
#include "service/programs/cl/words/motion.hpp"

namespace meridian::cl {
namespace {

constexpr double kMaxTimes = 1e6;
constexpr const char* kForms =
    "COPY/n and TRANSL,x,y,z,times; XYROT, YZROT or ZXROT,degrees,times; SAME,times; MODIFY, "
    "twelve numbers,times are read; else let the CAM system write the repeated motion out";

tl::unexpected<Refusal> not_understood(const Statement& s) {
  return refuse(
      std::string(s.major) + "/" + std::string(s.rest.substr(0, 60)) + " is not understood", kForms,
      std::string(s.major));
}

/// A whole number that argument `at` is; 0 where it is none above zero.
std::uint32_t count_at(const Statement& s, std::size_t at) {
  const Argument& a = s.arguments[at];
  const bool is_count =
      a.is_number && a.number >= 1 && a.number <= kMaxTimes && a.number == std::floor(a.number);
  return is_count ? static_cast<std::uint32_t>(a.number) : 0;
}

/// About which axis a word of rotation turns, from the first of its letters to the second; -1:
/// none.
int turned_about(std::string_view word) {
  if (is_word(word, "YZROT")) return 0;
  if (is_word(word, "ZXROT")) return 1;
  return is_word(word, "XYROT") ? 2 : -1;
}

/// What argument 1 and the numbers after it do in one pass; the count stands last.
Expected<Frame, Refusal> step_of(const Statement& s) {
  const std::string_view what = s.arguments[1].text;
  const std::size_t numbers = s.number_count - 2;  // without n and the count
  const auto number = [&s](std::size_t i) { return s.arguments[2 + i].number; };
  Frame step;
  if (is_word(what, "SAME") && numbers == 0) return step;
  if (is_word(what, "TRANSL") && numbers == 3) {
    step.origin = {number(0), number(1), number(2)};
    return step;
  }
  if (const int about = turned_about(what); about >= 0 && numbers == 1) {
    step.rotation = Eigen::AngleAxisd(number(0) * units::kDegree_rad, Vector3::Unit(about));
    return step;
  }
  if (!is_word(what, "MODIFY") || numbers != 12) return not_understood(s);
  std::array<double, 12> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = number(i);
  const auto frame = frame_from_rows(rows);
  if (frame) return *frame;
  return refuse("COPY/MODIFY with a matrix that scales, mirrors or is not square",
                "let the CAM system write the repeated motion out");
}

Copies::Start start_of(const Modal& m) { return {m.axis.written, m.cycle.has_value()}; }

}  // namespace

/// A point without axis is what the pattern or the file means where the axis that it relies on is
/// the one that stood there when the pattern ran first.
void put_copy_in_force(Modal& m, const Frame& before) {
  const Frame now = m.copies.transformation();
  m.frames.set_copy(m.copies.is_repeating() ? std::optional(now) : std::nullopt);
  const Vector3 axis = to_vector(m.axis.written);
  const bool is_changed = m.copies.is_at_begin()
                              ? m.copies.start().axis != m.axis.written
                              : !now.direction(axis).isApprox(before.direction(axis));
  if (is_changed) m.axis.source = ToolAxis::Source::kCopied;
}

/// INDEX/n, where a pattern begins, and INDEX/n,NOMORE, where it ends if that is not at the COPY.
Outcome read_index(Modal& m, const Statement& s) {
  const std::uint32_t number = s.argument_count > 0 ? count_at(s, 0) : 0;
  const bool is_end = s.argument_count == 2 && s.has_word("NOMORE");
  if (number == 0 || s.has_empty_argument() || (s.argument_count != 1 && !is_end)) {
    return refuse("INDEX/" + std::string(s.rest.substr(0, 60)) + " is not understood",
                  "INDEX/n begins a pattern that COPY/n repeats, INDEX/n,NOMORE ends it");
  }
  m.summary.skip(s.major, s.line);
  if (is_end) return m.copies.end_pattern(number);
  return m.copies.begin_pattern(number, start_of(m), s.line);
}

Outcome read_copy(Modal& m, const Statement& s) {
  const std::size_t n = s.argument_count;
  const bool has_form = n >= 3 && s.number_count + 1 == n && !s.arguments[1].is_number &&
                        s.fault == Statement::ArgumentFault::kNone;
  if (!has_form) return not_understood(s);
  const std::uint32_t number = count_at(s, 0), times = count_at(s, n - 1);
  if (number == 0 || times == 0) {
    return refuse("COPY without a whole number of its INDEX, or of its times", kForms);
  }
  const auto step = step_of(s);
  if (!step) return tl::make_unexpected(step.error());
  const Frame before = m.copies.transformation();
  if (auto done = m.copies.repeat(number, *step, times, start_of(m), s.line); !done) return done;
  m.remarks.warn("COPY", s.line, [number, times] {
    return "COPY: the motion after INDEX/" + std::to_string(number) + " is run " +
           std::to_string(times) + (times == 1 ? " time" : " times") + " more";
  });
  put_copy_in_force(m, before);
  return {};
}

}  // namespace meridian::cl
