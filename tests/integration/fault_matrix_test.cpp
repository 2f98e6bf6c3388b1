// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <ostream>
#include <set>
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

/// The slice: each phase, and each way in which faults are provoked.
constexpr std::array<std::pair<const char*, const char*>, 17> kSlice{{
    {"drives killed", "Ready"},
    {"service stopped, 700 ms", "Approaching"},
    {"station stopped", "in a cut, smooth"},
    {"service killed", "in a cut, exact stop"},
    {"set-up words", "in a cut, smooth"},
    {"a stranger's rubbish", "in a rapid"},
    {"wire: 5 % lost", "on the pole"},
    {"`deaf`, 600 ms", "Holding"},
    {"`spike`", "Held"},
    {"`silence`", "in a dwell"},
    {"`emergency`", "at a tool change"},
    {"`stale`, 20 ms", "Starved"},
    {"station killed", "in the last block"},
    {"stuck participant", "in a cut, exact stop"},
    {"forged sender", "Ready"},
    {"log blocked", "in a cut, smooth"},
    {"recovery killed twice", "in a cut, smooth"},
}};

[[nodiscard]] bool is_in_slice(const Pair& pair) {
  return std::ranges::any_of(kSlice, [&](const auto& one) {
    return std::string_view(one.first) == pair.fault->name &&
           std::string_view(one.second) == pair.phase->name;
  });
}

/// Every pair that there is.
[[nodiscard]] std::vector<Pair> all_pairs() {
  std::vector<Pair> all;
  for (const LiveFault& fault : live_faults()) {
    for (const Phase& phase : phases()) {
      if (expected(fault, phase) != "–") all.push_back({&fault, &phase});
    }
  }
  return all;
}

[[nodiscard]] std::vector<Pair> pairs_of_slice() {
  std::vector<Pair> some = all_pairs();
  std::erase_if(some, [](const Pair& pair) { return !is_in_slice(pair); });
  return some;
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

INSTANTIATE_TEST_SUITE_P(Of, FaultMatrix,
                         testing::ValuesIn(is_whole_matrix() ? all_pairs() : pairs_of_slice()),
                         name_of_pair);

TEST(FaultMatrixSlice, HasEveryPhaseAndEveryWayOfProvokingAFault) {
  const std::vector<Pair> slice = pairs_of_slice();
  EXPECT_EQ(slice.size(), kSlice.size()) << "a pair of it is none of the table's";
  std::set<const Phase*> met;
  std::set<LiveFault::How> done;
  for (const Pair& pair : slice) {
    met.insert(pair.phase);
    done.insert(pair.fault->how);
  }
  for (const Phase& phase : phases()) EXPECT_TRUE(met.contains(&phase)) << phase.name;
  for (const LiveFault& fault : live_faults()) EXPECT_TRUE(done.contains(fault.how)) << fault.name;
}

TEST(FaultMatrixTable, IsThatOfTheDocument) {
  expect_table_of_document(MERIDIAN_SOURCE_DIR "/docs/faults.md", "matrix", table_of_faults());
}

}  // namespace
}  // namespace meridian::test
