// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/interpreter/interpreter.hpp"

#include <algorithm>

#include "service/programs/cl/text/letters.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/cl/words/handlers.hpp"
#include "service/programs/cl/words/motion.hpp"
#include "service/programs/cl/words/word_table.hpp"

namespace meridian::cl {
namespace {

constexpr const char* kByForm =
    "write it in a form that `meridian cl --words` shows, or output the file anew";

ClReaderOptions in_capitals(ClReaderOptions options) {
  for (std::string& word : options.allowed_words) {
    for (char& c : word) c = capital(c);
  }
  return options;
}

bool is_outside_curves(Standing standing) {
  return standing == Standing::kOutsideCurves || standing == Standing::kListsOutsideCurves;
}

bool is_in_lists(Standing standing) {
  return standing == Standing::kInLists || standing == Standing::kListsOutsideCurves;
}

/// Behind a refusal of what moves, or of what may move, nobody knows where the tool is.
void lose_position(Modal& m) {
  m.curve = {};
  m.next = NextMotion::kFeed;
  m.path.lose_position();
}

}  // namespace

Interpreter::Interpreter(std::string name, ClReaderOptions options, LookAhead look_ahead)
    : name_(std::move(name)), modal_(in_capitals(std::move(options)), std::move(look_ahead)) {
  modal_.path.set_max_feed(modal_.options.max_feed_mm_per_s);
}

ClError Interpreter::error(std::uint32_t line, const Refusal& refusal) const {
  return {name_,           refusal.line > 0 ? refusal.line : line,
          refusal.message, refusal.remedy.empty() ? kByForm : refusal.remedy,
          refusal.group,   false};
}

void Interpreter::warn(std::string_view key, std::uint32_t line, const std::string& message) {
  modal_.remarks.warn(key, line, [&message] { return message; });
}

void Interpreter::see(Dialect dialect, std::uint32_t line, std::string_view what) {
  DialectFinder& finder = modal_.dialect;
  if (!finder.see(dialect, line, what)) {
    modal_.remarks.warn("two systems", line, [&] {
      return std::string(what) + " is a word of " + std::string(traits_of(dialect).title) +
             ", but " + finder.reason() + " shows " + std::string(finder.traits().title) +
             ": read as the latter; --dialect says which it is";
    });
  }
}

ClSummary& Interpreter::summary() {
  modal_.summary.dialect = modal_.dialect.traits().title;
  modal_.summary.dialect_reason = modal_.dialect.reason();
  return modal_.summary;
}

Outcome Interpreter::read_unknown(const Statement& s) {
  const auto& allowed = modal_.options.allowed_words;
  if (std::find(allowed.begin(), allowed.end(), s.major) != allowed.end()) {
    return pass_on(modal_, s);
  }
  if (s.rest.starts_with('=')) {
    return refuse("a definition in the source language of APT: " + quoted(s.major) + " = ...",
                  "output the CL file that its processor makes of it", "definition");
  }
  return refuse(
      "unknown word " + quoted(s.major),
      "--allow-unknown " + std::string(s.major) + " passes it to the machine as a vendor word",
      "unknown " + std::string(s.major));
}

/// Only some of these carry what the path needs.
Outcome Interpreter::read_comment_data(const Statement& s) {
  const bool is_matrix = s.source == Statement::Source::kCatiaMatrix;
  see(is_matrix ? Dialect::kCatia : Dialect::kCreo, s.line, is_matrix ? "$$*CATIA0" : "$$->");
  if (is_matrix || s.major == "CSYS") return read_csys(modal_, s);
  if (s.major == "CUTTER") return read_tool_data(modal_, s);
  if (s.major == "CUTCOM_GEOMETRY_TYPE") {
    modal_.cutcom_path =
        s.has_word("OUTPUT_ON_PROFILE") ? CutcomPath::kOfPart : CutcomPath::kOfTool;
  }
  return {};
}

Outcome Interpreter::read(const Statement& s) {
  ++modal_.summary.statements;
  if (s.source != Statement::Source::kText) return read_comment_data(s);
  if (s.major.empty()) return read_listed_point(modal_, s);
  if (modal_.curve.index() == 1) {
    if (auto done = end_listed_arc(modal_); !done) return done;
  }
  const WordRow* const row = find_word(s.major);
  if (row == nullptr) return read_unknown(s);
  if (row->shows != Dialect::kUnknown) see(row->shows, s.line, s.major);
  if (!is_in_lists(row->standing)) modal_.structure.kind = Structure::Kind::kProgram;
  if (modal_.curve.index() != 0 && is_outside_curves(row->standing)) {
    return refuse(std::string(s.major) + " between " +
                  (modal_.curve.index() == 1 ? "CIRCLE and the GOTO that ends the arc"
                                             : "NURBS and its last control point"));
  }
  return row->handler(modal_, s);
}

/// After END the machine may be switched off, and nothing else: the blocks from `before` on.
Outcome Interpreter::check_after_end(const Statement& s, std::size_t before, Blocks& out) const {
  const auto first = out.begin() + static_cast<std::ptrdiff_t>(before);
  const bool is_harmless = std::all_of(first, out.end(), [](const ClBlock& b) {
    return b.kind == BlockKind::kEnd || b.action == ActionKind::kSpindleOff ||
           b.action == ActionKind::kCoolantOff;
  });
  if (is_harmless) return {};
  return refuse(std::string(s.major) + " after the end of the program",
                "split the file: one program each", "after end");
}

/// In exact stop a cut ends in a rest; what the reader subdivides, as a spline, rests at its end
/// alone.
void Interpreter::rest_at_end(std::uint32_t line, std::size_t before, const Blocks& out) {
  const bool has_cut = out.size() > before && out.back().kind == BlockKind::kCut;
  if (modal_.join != BlockJoin::kExactStop || !has_cut) return;
  modal_.path.act(BlockKind::kDwell, ActionKind::kNone, 0, line);
}

Interpreter::Result Interpreter::take(const Statement& s, Blocks& out) {
  const bool is_after_end = modal_.structure.phase == Structure::Phase::kEnded;
  const std::size_t before = out.size();
  modal_.path.give_to(out);
  modal_.copies.record(s);
  auto done = read(s);
  if (done && is_after_end) done = check_after_end(s, before, out);
  if (done) [[likely]] {
    rest_at_end(s.line, before, out);
    return {};
  }
  out.resize(before);
  ++modal_.refusals;
  lose_position(modal_);
  return tl::make_unexpected(error(s.line, done.error()));
}

void Interpreter::go_on_repeating() {
  const Frame before = modal_.copies.transformation();
  if (modal_.copies.go_on()) put_copy_in_force(modal_, before);
}

Outcome Interpreter::check_whole(std::uint32_t last_line, bool open_end) {
  const auto cut_short = [](std::uint32_t line, const std::string& why) {
    return refuse_at(line, "the file is cut short: " + why, "output it anew");
  };
  Structure& structure = modal_.structure;
  if (const auto* const arc = std::get_if<PendingArc>(&modal_.curve)) {
    return cut_short(arc->line, "CIRCLE without the GOTO that ends the arc");
  }
  if (const auto* const spline = std::get_if<PendingSpline>(&modal_.curve)) {
    return cut_short(spline->line, "NURBS without all of its control points");
  }
  if (structure.phase == Structure::Phase::kEnded) return {};
  if (modal_.summary.statements == 0) return refuse("the file is empty");
  if (structure.open_path_line != 0) {
    return cut_short(structure.open_path_line, "this TOOL PATH has no END-OF-PATH");
  }
  if (structure.open_sections > 0) {
    return cut_short(last_line, "PPRINT/BEGIN-SECTION without END-SECTION");
  }
  if (!structure.has_closed && !modal_.options.allow_no_end) {
    if (structure.kind == Structure::Kind::kProgram) {
      return refuse_at(last_line, "the file is cut short: there is no FINI, END or END-OF-PATH",
                       "--allow-no-end takes it as whole");
    }
    modal_.remarks.warn("no end", last_line, [open_end] {
      return std::string("there is no FINI: the list of points is taken as whole") +
             (open_end ? ", its last line too, although no line end follows" : "");
    });
  }
  return {};
}

Interpreter::Result Interpreter::finish(std::uint32_t last_line, bool open_end, Blocks& out) {
  if (is_finished()) return {};
  modal_.path.give_to(out);
  const std::size_t before = out.size();
  auto done = end_listed_arc(modal_);
  if (done) done = check_whole(last_line, open_end);
  if (done && !modal_.path.has_moved() && modal_.refusals == 0)
    done = refuse("there is no motion in the file");
  if (!done) {
    out.resize(before);
    return tl::make_unexpected(error(0, done.error()));
  }
  modal_.structure.phase = Structure::Phase::kFinished;
  modal_.path.act(BlockKind::kEnd, ActionKind::kNone, 0, last_line);
  return {};
}

}  // namespace meridian::cl
