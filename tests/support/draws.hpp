// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <initializer_list>
#include <iterator>
#include <vector>

namespace meridian::test {

/// How many of `all` draws of a property test are made. Sanitizers make a program run ten times as
/// long: there a sixteenth of the draws sees the same code. Whole builds make them all.
[[nodiscard]] constexpr int draws(int all) noexcept {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return (all + 15) / 16;
#else
  return all;
#endif
}

/// What the environment sets for a longer run, which anyone may start: a seed, a count.
template <class Number>
[[nodiscard]] Number number_of(const char* name, Number otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : static_cast<Number>(std::strtoull(text, nullptr, 10));
}

/// Whether times mean anything: not in a build that a sanitizer slows down.
inline constexpr bool kIsTimed = draws(16) == 16;

/// The cases of a test; under sanitizers its first and its last, which see the same code.
template <class Case>
[[nodiscard]] std::vector<Case> cases(std::vector<Case> all) {
  if (!kIsTimed && all.size() > 2) all.erase(std::next(all.begin()), std::prev(all.end()));
  return all;
}
template <class Case>
[[nodiscard]] std::vector<Case> cases(std::initializer_list<Case> all) {
  return cases(std::vector<Case>(all));
}

}  // namespace meridian::test
