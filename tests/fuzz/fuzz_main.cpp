// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_targets.hpp"

/// The entry of libFuzzer; MERIDIAN_FUZZ_TARGET is one of the functions of fuzz_targets.hpp.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  meridian::fuzz::MERIDIAN_FUZZ_TARGET({data, size});
  return 0;
}
