// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace meridian::test {

/// How many of `all` draws of a property test are made. Sanitizers make a program run ten times as
/// long: there an eighth of the draws sees the same code. Whole builds make them all.
[[nodiscard]] constexpr int draws(int all) noexcept {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return (all + 7) / 8;
#else
  return all;
#endif
}

/// Whether times mean anything: not in a build that a sanitizer slows down.
inline constexpr bool kIsTimed = draws(8) == 8;

}  // namespace meridian::test
