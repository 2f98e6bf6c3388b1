// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "integration/fault_case.hpp"
#include "support/document_table.hpp"

/// Every fault that can be provoked between processes in every phase of a program. A slice of it
/// in ctest; MERIDIAN_FAULT_MATRIX=all in the environment makes it all of them, forty minutes.
namespace meridian::test {
namespace {

struct Pair {
  const LiveFault* fault;
  const Phase* phase;
};

void PrintTo(const Pair& pair, std::ostream* out) {
  *out << pair.fault->name << ", " << pair.phase->name;
}

/// The slice: each kind of fault and each phase once or twice.
constexpr std::array<std::pair<const char*, const char*>, 11> kSlice{{
    {"station stopped", "in a cut, smooth"},
    {"service killed", "in a cut, exact stop"},
    {"service stopped, 700 ms", "on the pole"},
    {"drives killed", "Held"},
    {"`silence`", "Starved"},
    {"`emergency`", "at a tool change"},
    {"`deaf`, 600 ms", "Holding"},
    {"`stale`, 20 ms", "in a dwell"},
    {"a stranger's rubbish", "in the last block"},
    {"wire: 5 % lost", "on the pole"},
    {"wire: 5 % spoilt", "Held"},
}};

[[nodiscard]] std::vector<Pair> pairs() {
  std::vector<Pair> all;
  for (const LiveFault& fault : live_faults()) {
    for (const Phase& phase : phases()) {
      const bool is_in_slice = std::ranges::any_of(kSlice, [&](const auto& one) {
        return std::string_view(one.first) == fault.name &&
               std::string_view(one.second) == phase.name;
      });
      if (expected(fault, phase) != "–" && (is_whole_matrix() || is_in_slice))
        all.push_back({&fault, &phase});
    }
  }
  return all;
}

[[nodiscard]] std::string name_of_pair(const testing::TestParamInfo<Pair>& info) {
  std::string name;
  bool begins = true;
  for (const char c : std::string(info.param.fault->name) + " " + info.param.phase->name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) {
      begins = true;
      continue;
    }
    name += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = false;
  }
  return name;
}

class FaultMatrix : public testing::TestWithParam<Pair> {};

TEST_P(FaultMatrix, EndsAsTheDocumentSaysAndTheRestIsCut) {
  const auto& [fault, phase] = GetParam();
  if (fault->how == LiveFault::How::kWire) {
    if (const std::string why = Hosts::why_not(); !why.empty()) GTEST_SKIP() << why;
  }
  FaultCase one(*fault, *phase);
  one.run();
  std::printf("%s, %s: %s\n", fault->name, phase->name, one.letter().c_str());
  if (const std::string host = one.host_said(); HasFailure() && !host.empty()) {
    ADD_FAILURE() << host;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, FaultMatrix, testing::ValuesIn(pairs()), name_of_pair);

TEST(FaultMatrixTable, IsThatOfTheDocument) {
  expect_table_of_document(MERIDIAN_SOURCE_DIR "/docs/faults.md", "matrix", table_of_faults());
}

}  // namespace
}  // namespace meridian::test
