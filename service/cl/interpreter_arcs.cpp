// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>

#include "service/cl/interpreter.hpp"
#include "service/cl/number.hpp"

namespace meridian::cl {
namespace {

/// The numbers inside the bracket that `keyword` opens, e.g. of "(CIRCLE/ 1, 2, 3, 4)": up to 7.
struct Numbers {
  std::array<double, 7> value{};
  std::size_t count = 0;
};

Numbers numbers_of(std::string_view text, std::size_t at) {
  Numbers numbers;
  while (at < text.size() && text[at] != ')' && numbers.count < numbers.value.size()) {
    if (!starts_number(text[at])) {
      ++at;
      continue;
    }
    std::size_t stop = at;
    while (stop < text.size() && text[stop] != ',' && text[stop] != ' ' && text[stop] != ')') {
      ++stop;
    }
    if (!parse_number(text.substr(at, stop - at), numbers.value[numbers.count++])) return {};
    at = stop;
  }
  return numbers;
}

Numbers numbers_behind(std::string_view text, std::string_view keyword, bool last) {
  const std::size_t at = last ? text.rfind(keyword) : text.find(keyword);
  return at == std::string_view::npos ? Numbers{} : numbers_of(text, at + keyword.size());
}

}  // namespace

Interpreter::Result Interpreter::take_circle(const Statement& s) {
  if (arc_.form != ArcForm::kNone) {
    return refuse(arc_.line, "CIRCLE without the GOTO that ends the arc");
  }
  std::size_t n = 0;
  while (n < s.argument_count && s.arguments[n].is_number) ++n;
  PendingArc arc;
  arc.line = s.line;
  const bool has_times = n + 2 == s.argument_count && is_word(s.arguments[n].text, "TIMES") &&
                         s.arguments[n + 1].is_number;
  if (s.has_empty_argument || (n != s.argument_count && !has_times)) {
    return refuse(s.line, "CIRCLE holds something that is no number");
  }
  if (has_times) {
    const double turns = s.arguments[n + 1].number;
    if (!(turns >= 1 && turns <= 1000 && turns == static_cast<int>(turns))) {
      return refuse(s.line, "CIRCLE/...,TIMES needs a whole number from 1 to 1000");
    }
    arc.turns = static_cast<int>(turns);
  }
  switch (n) {
    case 4:
      if (!forward_) {
        return refuse(s.line, "CIRCLE with 4 numbers does not tell which way it turns",
                      "write INDIRV before it, or output CIRCLE with its normal");
      }
      arc.form = ArcForm::kForward;
      arc.radius = s.arguments[3].number;
      break;
    case 6:
    case 7:
      arc.form = ArcForm::kRight;
      break;
    case 11:
      arc.form = ArcForm::kClockwise;
      break;
    default:
      return refuse(s.line, "CIRCLE needs 4, 6, 7 or 11 numbers, here are " + std::to_string(n));
  }
  const std::size_t vector = n == 4 ? 3 : 6;
  for (std::size_t i = 0; i < vector; ++i) arc.centre_normal[i] = s.arguments[i].number;
  if (n >= 7) arc.radius = s.arguments[6].number;
  if (!(arc.radius >= 0)) return refuse(s.line, "CIRCLE has a negative radius");
  arc_ = arc;
  return {};
}

Interpreter::Result Interpreter::take_forward(const Statement& s) {
  if (s.argument_count != 3 || !s.all_numbers()) {
    return refuse(s.line, "INDIRV needs the three numbers of the forward direction");
  }
  forward_ = {s.arguments[0].number, s.arguments[1].number, s.arguments[2].number};
  return {};
}

/// CATIA: TLON,GOFWD/ (CIRCLE/ centre, radius),ON,(LINE/ centre, end) after INDIRV; on an inclined
/// plane (CYLNDR/ centre, axis, radius),ON,(PLANE/PERPTO,...,(POINT/ end)).
Interpreter::Result Interpreter::take_tool_on(const Statement& s, Blocks& out) {
  if (!forward_) {
    return refuse(s.line, "TLON without the INDIRV that tells which way the arc turns");
  }
  std::string text(s.rest);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const Numbers circle = numbers_behind(text, "CIRCLE", false);
  const Numbers cylinder = numbers_behind(text, "CYLNDR", false);
  const Numbers line = numbers_behind(text, "LINE", false);
  const Numbers point = numbers_behind(text, "POINT", true);
  PendingArc arc;
  arc.form = ArcForm::kForward;
  arc.line = s.line;
  std::array<double, 3> end{};
  if (circle.count == 4 && line.count == 6) {
    arc.radius = circle.value[3];
    std::copy_n(circle.value.begin(), 3, arc.centre_normal.begin());
    std::copy_n(line.value.begin() + 3, 3, end.begin());
  } else if (cylinder.count == 7 && point.count == 3) {
    arc.radius = cylinder.value[6];
    std::copy_n(cylinder.value.begin(), 3, arc.centre_normal.begin());
    std::copy_n(point.value.begin(), 3, end.begin());
  } else {
    return refuse(
        s.line,
        "TLON in a form that is not understood: neither CIRCLE and LINE nor CYLNDR and POINT");
  }
  if (auto done = prepare_motion(s.line); !done) return done;
  Vector3 tip;
  if (auto done = point_of(end.data(), s.line, tip); !done) return done;
  arc_ = arc;
  return arc_to(tip, s.line, out);
}

}  // namespace meridian::cl
