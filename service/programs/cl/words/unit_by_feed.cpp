// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/words/unit_by_feed.hpp"

#include "service/programs/cl/words/handlers.hpp"
#include "service/programs/cl/words/word_table.hpp"

namespace meridian::cl {
namespace {

std::optional<ShownUnit> unit_shown_by(const Statement& s) {
  for (std::size_t i = 0; i < s.argument_count; ++i) {
    if (s.arguments[i].is_number) continue;
    const auto unit = length_unit_of(feed_unit_of(s.arguments[i].text));
    if (unit) return ShownUnit{*unit, s.line};
  }
  return std::nullopt;
}

std::optional<ShownUnit> find_unit_by_feed(LineSource& lines) {
  StatementReader statements(lines);
  Statement s;
  while (statements.next(s) == StatementReader::Outcome::kStatement) {
    if (s.source != Statement::Source::kText || s.major.empty()) continue;
    const WordRow* const row = find_word(s.major);
    if (row == nullptr) continue;
    if (row->handler == read_units || row->handler == read_fini) break;
    if (row->handler != read_feed && row->handler != read_cycle_word) continue;
    if (const auto shown = unit_shown_by(s)) return shown;
  }
  return std::nullopt;
}

}  // namespace

void see_unit_by_feed(Modal& m, const Statement& s) {
  if (!m.units.in_force && !m.units.by_feed) m.units.by_feed = unit_shown_by(s);
}

std::optional<ShownUnit> unit_by_feed_ahead(LineSource& lines) {
  std::optional<ShownUnit> shown;
  (void)lines.look_ahead([&shown](LineSource& ahead) { shown = find_unit_by_feed(ahead); });
  return shown;
}

}  // namespace meridian::cl
