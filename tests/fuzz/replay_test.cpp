// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <random>
#include <vector>

#include "fuzz/fuzz_targets.hpp"
#include "fuzz/wire_samples.hpp"

/// Fuzzing as CI can afford it: the seeds, among them everything that fuzzing found before, and
/// what a few thousand changes drawn with a fixed seed make of them. A finding ends the process.
namespace meridian::fuzz {
namespace {

using Input = std::vector<std::uint8_t>;

[[nodiscard]] Input changed(Input input, std::mt19937_64& random) {
  const auto below = [&random](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  for (std::size_t n = 1 + below(4); n > 0 && !input.empty(); --n) {
    const auto at = static_cast<std::ptrdiff_t>(below(input.size()));
    switch (below(4)) {
      case 0:
        input[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(below(256));
        break;
      case 1:
        input.resize(static_cast<std::size_t>(at));
        break;
      case 2:
        input.erase(input.begin() + at);
        break;
      default:
        input.insert(input.begin() + at, 1 + below(8), below(2) == 0 ? 0xff : 0);
        break;
    }
  }
  return input;
}

void replay(const Target& target, const Seeds& seeds) {
  ASSERT_FALSE(seeds.empty());
  for (const Input& seed : seeds) target.run(seed);
  constexpr std::uint64_t kSeed = 11;
  constexpr int kChanges = 6000;
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < kChanges; ++i) {
    target.run(changed(seeds[static_cast<std::size_t>(i) % seeds.size()], random));
  }
  std::printf("%zu inputs and %d changed ones, seed %lu\n", seeds.size(), kChanges,
              static_cast<unsigned long>(kSeed));
}

TEST(Fuzzing, OfTheClReaderFindsNothing) { replay(kTargets[0], cl_seeds()); }

TEST(Fuzzing, OfTheNcReaderFindsNothing) { replay(kTargets[3], nc_seeds()); }

TEST(Fuzzing, OfTheMachineFileFindsNothing) {
  replay(kTargets[1], machine_seeds(MERIDIAN_SOURCE_DIR "/deploy/machines"));
}

TEST(Fuzzing, OfEveryWireTypesCheckFindsNothing) { replay(kTargets[2], wire_seeds()); }

TEST(Fuzzing, OfTheWireBeginsWithAndWithoutWhateverASampleMayHave) {
  for (const Input& seed : wire_seeds()) check_wire(seed);
  for (std::size_t choice = 0; choice < kWireChoices; ++choice) {
    EXPECT_TRUE(wire_choices()[choice][0]) << "never without: WireChoice " << choice;
    EXPECT_TRUE(wire_choices()[choice][1]) << "never with: WireChoice " << choice;
  }
}

TEST(FuzzingDeathTest, EndsWithWhatItFound) {
  EXPECT_DEATH(require(false, "something"), "found: something");
}

}  // namespace
}  // namespace meridian::fuzz
