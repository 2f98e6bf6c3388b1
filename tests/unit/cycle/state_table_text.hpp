// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <sstream>
#include <string>

#include "meridian/cycle/state_table.hpp"

/// The table verb × state as the Markdown of docs/operating.md.
namespace meridian::testing {

inline void write(std::ostream& out, const VerbEffect& cell) {
  switch (cell.effect) {
    case Effect::kGo:
      out << " → " << name_of(cell.next) << " |";
      return;
    case Effect::kAlready:
      out << " already so |";
      return;
    case Effect::kSet:
      out << " set |";
      return;
    case Effect::kRefused:
      out << " no: " << name_of(cell.refusal) << " |";
  }
}

[[nodiscard]] inline std::string state_table_text() {
  std::ostringstream out;
  out << "| state |";
  for (int v = 0; v < kVerbCount; ++v) out << ' ' << name_of(static_cast<Verb>(v)) << " |";
  out << "\n|---|";
  for (int v = 0; v < kVerbCount; ++v) out << "---|";
  for (int s = 0; s < kStateCount; ++s) {
    const auto state = static_cast<State>(s);
    out << "\n| " << name_of(state) << " |";
    for (int v = 0; v < kVerbCount; ++v) write(out, effect_of(state, static_cast<Verb>(v)));
  }
  out << '\n';
  return out.str();
}

}  // namespace meridian::testing
