// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "service/programs/cl/cl_error.hpp"

namespace meridian::cl {

/// Something about a file: why it is refused, or what its reader should know. Alike ones are one.
struct Finding {
  enum class Severity : std::uint8_t { kRefusal, kWarning };
  Severity severity = Severity::kRefusal;
  std::uint32_t line = 0;  ///< of the first finding; 0: the whole file
  std::string message;     ///< of the first finding
  std::string remedy;
  std::uint64_t count = 1;  ///< places
};

/// All that was found in one pass over a file, whoever found it: reader, tools, reach, travel.
/// Bounded: kinds beyond kMaxKinds are only counted. Proof: tests/unit/cl/findings_test.cpp.
class Findings {
 public:
  static constexpr std::size_t kMaxKinds = 200;

  /// Refusals of one group are alike; where it is empty, those whose messages differ in numbers
  /// alone.
  void add(const ClError& error);
  void add(const ClWarning& warning);

  [[nodiscard]] bool is_refused() const noexcept { return refusals_ > 0; }
  [[nodiscard]] std::uint64_t refusals() const noexcept { return refusals_; }
  /// By line, refusals first where lines are equal.
  [[nodiscard]] std::vector<Finding> sorted() const;

 private:
  std::vector<Finding> findings_;
  std::vector<std::string> groups_;  ///< beside findings_
  std::uint64_t refusals_ = 0;
};

/// "FILE:LINE: message (12 places); remedy", a line each; warnings say so.
[[nodiscard]] std::string to_text(const std::vector<Finding>& findings, const std::string& file);
/// A JSON array of objects with line, severity, message, remedy and count.
[[nodiscard]] std::string to_json(const std::vector<Finding>& findings);

}  // namespace meridian::cl
