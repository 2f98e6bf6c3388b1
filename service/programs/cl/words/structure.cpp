// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/cl/words/handlers.hpp"
#include "service/programs/cl/words/word_table.hpp"

namespace meridian::cl {

Outcome read_tool_path(Modal& m, const Statement& s) {
  Structure& structure = m.structure;
  if (structure.open_path_line != 0) {
    return refuse("TOOL PATH inside the TOOL PATH of line " +
                  std::to_string(structure.open_path_line) + ": the file is cut and joined?");
  }
  structure.open_path_line = s.line;
  if (m.summary.program.empty()) {
    m.summary.program = std::string(s.rest.substr(0, std::min<std::size_t>(s.rest.find(','), 80)));
  }
  return {};
}

Outcome read_end_of_path(Modal& m, const Statement&) {
  m.structure.open_path_line = 0;
  m.structure.has_closed = true;
  m.is_cycle_of_path_before = m.cycle.has_value();
  return {};
}

/// The end block comes last: it waits for FINI or the end of the file, as posts switch spindle and
/// coolant off after END.
Outcome read_end(Modal& m, const Statement&) {
  if (const auto* const arc = std::get_if<PendingArc>(&m.curve)) {
    return refuse_at(arc->line, "CIRCLE without the GOTO that ends the arc");
  }
  if (const auto* const spline = std::get_if<PendingSpline>(&m.curve)) {
    return refuse_at(spline->line, "NURBS without all of its control points");
  }
  if (!m.path.has_moved() && m.refusals == 0) return refuse("there is no motion in the file");
  m.structure.phase = Structure::Phase::kEnded;
  return {};
}

Outcome read_fini(Modal& m, const Statement& s) {
  if (auto done = read_end(m, s); !done) return done;
  m.structure.phase = Structure::Phase::kFinished;
  m.path.act(BlockKind::kEnd, ActionKind::kNone, 0, s.line);
  return {};
}

Outcome read_program_name(Modal& m, const Statement& s) {
  const std::size_t begin = s.rest.find_first_not_of(' ');
  if (m.summary.program.empty() && begin != std::string_view::npos) {
    m.summary.program = std::string(s.rest.substr(begin, 80));
  }
  return {};
}

/// PPRINT is free text; Makino writes its structure into it.
Outcome read_note(Modal& m, const Statement& s) {
  std::string_view text = s.rest;
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  if (!m.dialect.is_known()) (void)m.dialect.see(shown_by_text(text), s.line, "PPRINT");
  const auto begins_with = [text](std::string_view word) {
    return is_word(text.substr(0, word.size()), word);
  };
  if (begins_with("BEGIN-SECTION")) ++m.structure.open_sections;
  if (begins_with("END-SECTION")) {
    if (m.structure.open_sections == 0) {
      return refuse("PPRINT/END-SECTION without BEGIN-SECTION");
    }
    --m.structure.open_sections;
    m.structure.has_closed = true;
  }
  return skip(m, s);
}

Outcome skip(Modal& m, const Statement& s) {
  m.summary.skip(s.major, s.line);
  return {};
}

Outcome skip_flagged(Modal& m, const Statement& s) {
  m.summary.skip(s.major, s.line);
  m.remarks.warn(s.major, s.line, [&s] {
    return std::string(s.major) + " " + std::string(find_word(s.major)->note);
  });
  return {};
}

/// The remedy stands behind the `;` of the note.
Outcome refuse_word(Modal&, const Statement& s) {
  const std::string_view note = find_word(s.major)->note;
  const std::size_t stop = std::min(note.find("; "), note.size());
  return refuse(std::string(s.major) + " " + std::string(note.substr(0, stop)),
                stop < note.size() ? std::string(note.substr(stop + 2))
                                   : "let the CAM system output the moves themselves",
                std::string(s.major));
}

Outcome refuse_unless_off(Modal& m, const Statement& s) {
  return s.has_word("OFF") ? skip(m, s) : refuse_word(m, s);
}

Outcome refuse_unless_first(Modal& m, const Statement& s) {
  const bool is_first =
      s.argument_count == 1 && s.arguments[0].is_number && s.arguments[0].number == 1;
  return is_first ? skip(m, s) : refuse_word(m, s);
}

}  // namespace meridian::cl
