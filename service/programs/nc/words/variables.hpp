// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "service/programs/cl/refusal.hpp"

namespace meridian::nc {

/// The numbers that a program gives names to: R parameters of Siemens and what DEF declares, Q
/// parameters of Klartext. As no jump and no condition is run, a name stands for the number that
/// the last line above gave it. Proof: tests/unit/nc/siemens_variable_test.cpp.
class Variables {
 public:
  static constexpr std::size_t kMax = 1000;

  /// Takes the text after DEF: "REAL _X, _Y=2.5".
  [[nodiscard]] cl::Outcome declare(std::string_view text);
  [[nodiscard]] bool has(std::string_view name) const { return numbers_.contains(name); }
  /// Gives a declared name, or an R or Q parameter, its number.
  [[nodiscard]] cl::Outcome set(std::string_view name, double number);
  /// Nothing where no line gave it a number.
  [[nodiscard]] std::optional<double> find(std::string_view name) const;

 private:
  std::map<std::string, std::optional<double>, std::less<>> numbers_;
};

/// R1, R20.
[[nodiscard]] bool is_r_parameter(std::string_view name) noexcept;

}  // namespace meridian::nc
